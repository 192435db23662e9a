#include "schedules/synthesis/instants/measured.h"

#include <fmt/format.h>

#include <algorithm>

#include "schedules/analysis/clock_bounds.h"
#include "schedules/check/checker.h"

namespace ttf::schedules::synthesis::instants {

using plan::Goal;
using plan::Plan;
using plan::PlannedChain;

namespace {

// Returns the age that the instants alone make, as the check bounds it: with both ends' difference and the drift of clocks.
Duration nominal_age(const model::Cluster& cluster, Ticks age) {
  const analysis::ClockBounds clocks = analysis::clock_bounds(cluster);
  const std::int64_t ns = age * cluster.flexray.gdMacrotick_ps / 1'000;
  return {ns + clocks.apart_ns + clocks.drift_ns(ns)};
}

}  // namespace

Measured measure(const Plan& plan, const Placed& placed, Synthesis& made) {
  Measured all;
  for (std::size_t c = 0; c < plan.chains.size(); ++c) {
    const PlannedChain& chain = plan.chains[c];
    const AgeBounds age = age_bounds(made.cluster, chain);
    made.ages.push_back(age);
    const Duration period =
        made.cluster.cycle() * made.cluster.node(chain.node).tasks[chain.task].activation.at.repetition;
    all.worst = std::max(all.worst, age.worst);
    all.data = std::max(all.data, age.worst + period);
    all.jitter = std::max(all.jitter, age.worst - age.best);
    const Duration beyond = age.worst - nominal_age(made.cluster, placed.ages[c]);
    if (beyond > Duration::microseconds(2)) all.beyond = std::max(all.beyond, beyond);
  }
  return all;
}

std::vector<Finding> too_old(const Plan& plan, const Synthesis& made) {
  std::vector<Finding> findings;
  for (std::size_t c = 0; c < plan.chains.size(); ++c) {
    const PlannedChain& chain = plan.chains[c];
    if (!chain.largest_age || made.ages[c].worst <= *chain.largest_age) continue;
    findings.push_back(
        {plan.cluster.file, chain.line, fmt::format("plan.chains.{}.largest_age", chain.name),
         check::ms(*chain.largest_age),
         fmt::format("must be at least {} for the instants that were found", check::ms(made.ages[c].worst))});
  }
  return findings;
}

std::vector<Reached> bounded_by(std::vector<Reached> reached, const std::vector<Reached>& of_all) {
  for (std::size_t i = 0; i < reached.size(); ++i) {
    Reached& one = reached[i];
    one.bound = one.goal == Goal::kRoom ? std::max(one.bound, of_all[i].bound) : std::min(one.bound, of_all[i].bound);
    one.proven = one.value == one.bound && one.supposes.empty();
  }
  return reached;
}

std::vector<Reached> in_units(std::vector<Reached> reached, const Measured& measured, const model::Cluster& cluster) {
  const double tick_ms = static_cast<double>(cluster.flexray.gdMacrotick_ps) / 1e9;
  for (Reached& one : reached) {
    const double off = one.value - one.bound;
    if (one.goal == Goal::kWorstAge) one.value = in_ms(measured.worst);
    if (one.goal == Goal::kDataAge) one.value = in_ms(measured.data);
    if (one.goal != Goal::kWorstAge && one.goal != Goal::kDataAge && one.goal != Goal::kJitter) continue;
    if (one.goal == Goal::kJitter) {  // clocks make jitter, too: its bound stays 0
      one.value = in_ms(measured.jitter);
      one.proven = one.value == one.bound;
      continue;
    }
    one.bound = one.value - off * tick_ms - in_ms(measured.beyond);
    one.proven = one.value == one.bound;
  }
  return reached;
}

}  // namespace ttf::schedules::synthesis::instants
