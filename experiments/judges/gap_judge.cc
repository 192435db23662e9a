#include "experiments/judges/gap_judge.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>

namespace ttf::experiments::judges {

using schedules::synthesis::instants::judging::ChainEnd;
using schedules::synthesis::instants::judging::Coming;
using schedules::synthesis::instants::judging::FirstUse;
using schedules::synthesis::instants::judging::Prospect;
using schedules::synthesis::plan::Plan;

namespace {

// Returns, by use of the chain, the newest measurement that it rests on.
CommandRound commands_of(const ChainEnd& chain_end, std::size_t chain, Duration delay) {
  CommandRound round{chain_end.round, {}, {}};
  for (const FirstUse& one : chain_end.first_uses)
    if (one.chain == chain) round.samples.push_back(one.measured);
  for (const Duration use : chain_end.uses) {
    std::optional<Duration> newest;
    for (const FirstUse& one : chain_end.first_uses) {
      if (one.chain != chain) continue;
      const std::int64_t behind = (use - one.used).ns, length = chain_end.round.ns;
      const std::int64_t rounds = (behind - (behind % length + length) % length) / length;
      newest = std::max(newest.value_or(Duration{INT64_MIN}), one.measured + chain_end.round * rounds);
    }
    round.commands.push_back({use + delay, *newest});
  }
  return round;
}

bool once_a_use(const Prospect& prospect, const Coming& one) { return one.period == prospect.every; }

}  // namespace

GapJudge::GapJudge(const Plan& plan)
    : vehicle_{plan.gap_error.time_gap_s, plan.gap_error.lag_s, plan.gap_error.memory_s, plan.gap_error.density},
      delay_(plan.gap_error.delay) {}

double GapJudge::at_age(Duration period, Duration age) const {
  const auto [known, fresh] = known_.try_emplace({period, age}, 0.0);
  if (fresh) known->second = gap_error(vehicle_, {period, {Duration{}}, {{age + delay_, Duration{}}}});
  return known->second;
}

double GapJudge::of(const std::vector<ChainEnd>& chain_ends, const std::vector<double>& weights) const {
  double most = 0.0;
  for (const ChainEnd& chain_end : chain_ends) {
    std::set<std::size_t> chains;
    for (const FirstUse& one : chain_end.first_uses) chains.insert(one.chain);
    for (const std::size_t chain : chains) {
      const CommandRound round = commands_of(chain_end, chain, delay_);
      const bool one_age = round.samples.size() == 1 && round.commands.size() == 1;
      const double error = one_age ? at_age(round.length, round.commands[0].at - delay_ - round.commands[0].sampled)
                                   : gap_error(vehicle_, round);
      most = std::max(most, error);
    }
  }
  return weights[0] * most;
}

double GapJudge::bound(const std::vector<Prospect>& prospects, const std::vector<double>& weights, double enough,
                       int) const {
  double bound = 0.0;
  for (const Prospect& prospect : prospects) {
    const auto& coming = prospect.coming;
    const bool all =
        std::all_of(coming.begin(), coming.end(), [&](const Coming& one) { return once_a_use(prospect, one); });
    for (const Coming& one : coming) {
      if (!once_a_use(prospect, one)) continue;
      // Chains of one period have one error by age: the oldest is the worst.
      const Duration least = all ? prospect.least_worst_age : one.least_age;
      const double best = weights[0] * at_age(one.period, least);
      bound = std::max(bound, best);
      if (bound > enough || !std::isfinite(bound)) break;
      double before = best;
      for (int step = 1; step <= kSteps; ++step) {
        const double error = weights[0] * at_age(one.period, least + Duration{one.period.ns * step / kSteps});
        if (error < before) return 0.0;
        before = error;
      }
    }
  }
  return bound;
}

std::string GapJudge::supposes() const { return "the error grows with the age"; }

}  // namespace ttf::experiments::judges
