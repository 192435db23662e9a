#include "schedules/synthesis/instants/synthesize.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "schedules/check/checker.h"
#include "schedules/model/limits.h"
#include "schedules/synthesis/instants/measured.h"
#include "schedules/synthesis/instants/objectives/optimiser.h"
#include "schedules/synthesis/instants/placement.h"
#include "schedules/synthesis/instants/reading.h"
#include "schedules/synthesis/plan/loader.h"

namespace ttf::schedules::synthesis::instants {

using plan::Goal;
using plan::in_the_files;
using plan::Plan;
using plan::PlannedChain;
using plan::PlannedList;
namespace {

// Throws what is wrong at any instants: every list stands in slots of its own for this.
void refuse_contradictions(const Plan& plan, const Timed& timed) {
  model::Cluster cluster = timed.cluster;
  cluster.parameter_lines = plan.unchanging->parameter_lines;
  check::ClusterFindings findings(cluster);
  check_cycle(cluster, findings);
  int slot = 1;
  for (const model::FrameSlot& frame : cluster.frames) slot = std::max(slot, frame.slot + 1);
  for (const PlannedList& list : plan.lists)
    if (!list.at.instant) slot = std::max(slot, list.slot + cluster.pdu(list.pdu).max_fragments());
  for (const PlannedList& list : plan.lists)
    for (int f = 0; f < cluster.pdu(list.pdu).max_fragments(); ++f)
      cluster.frames.push_back({list.at.instant ? slot++ : list.slot + f, list.channels, 0,
                                list.at.instant ? 1 : list.repetition, list.sender, list.pdu, f, list.line});
  std::stable_sort(cluster.frames.begin(), cluster.frames.end(),
                   [](const auto& a, const auto& b) { return a.slot < b.slot; });
  cluster.flexray.gNumberOfStaticSlots = std::max(cluster.flexray.gNumberOfStaticSlots, slot);
  check_slots(cluster, findings);
  check_clocks(cluster, findings);
  check_can(cluster, findings);
  check_flow(cluster, findings);
  std::vector<Finding> found = in_the_files(plan, findings.take());
  if (!found.empty()) throw InputError(std::move(found));
}

std::vector<Candidate> checked_candidates(const Plan& plan) {
  std::vector<Candidate> all = candidates(plan);
  if (all.size() > kMostCandidates)
    throw InputError(
        {plan.cluster.file, plan.cycle.line, "plan", "",
         "must allow at most 20000 choices of cycle and rates: a larger step or narrower rates make fewer"});
  for (const Candidate& candidate : all)
    if (const auto made = timed(plan, candidate)) {
      refuse_contradictions(plan, *made);
      break;
    }
  return all;
}

}  // namespace

Synthesis synthesize(const Plan& plan, const judging::Judges& judges) {
  constexpr std::size_t kMostRefusals = 16;
  const std::vector<Candidate> all = checked_candidates(plan);
  Synthesis made;
  made.candidates = all.size();
  std::set<std::size_t> refused;
  std::vector<Reached> of_all;  // with every candidate
  while (refused.size() < kMostRefusals) {
    objectives::Optimiser optimiser(plan, all, refused, judges);
    const auto chosen = optimiser.run();
    made.exact = optimiser.exact();
    if (refused.empty()) of_all = optimiser.reached();
    if (!chosen) return made;
    const judging::Trial& trial = optimiser.trial(*chosen);
    const auto read = read_of(plan, trial);
    made.cluster = with_instants(plan, read->timed, read->reading, trial.placed->solution);
    std::vector<Finding> findings = check::check(made.cluster);
    if (findings.empty()) {
      made.ages.clear();
      const Measured measured = measure(plan, *trial.placed, made);
      findings = too_old(plan, made);
      made.found = findings.empty();
      made.candidate = trial.candidate;
      made.reached = in_units(bounded_by(optimiser.reached(), of_all), measured, made.cluster);
      if (made.found) return made;
    }
    if (made.refused.empty()) made.refused = std::move(findings);
    refused.insert(*chosen);
  }
  return made;
}

Feasible feasible(const Plan& plan) {
  Feasible result{false, true};
  for (const Candidate& candidate : candidates(plan)) {
    const auto read = read_of(plan, candidate);
    if (!read) continue;
    const Search found = place(read->reading, {}, true);
    if (found.best) return {true, true};
    result.exact = result.exact && found.exact;
  }
  return result;
}

bool passes(const Plan& plan) {
  for (const Candidate& candidate : candidates(plan)) {
    const auto read = read_of(plan, candidate);
    if (!read) continue;
    const Search found = place(read->reading, {}, true);
    if (found.best && check::check(with_instants(plan, read->timed, read->reading, found.best->solution)).empty())
      return true;
  }
  return false;
}

}  // namespace ttf::schedules::synthesis::instants
