#include "experiments/judges/error_judge.h"

#include <algorithm>

#include "core/check.h"
#include "experiments/judges/least_error.h"
#include "experiments/judges/trial_path.h"

namespace ttf::experiments::judges {

using schedules::synthesis::instants::judging::ChainEnd;
using schedules::synthesis::instants::judging::Coming;
using schedules::synthesis::instants::judging::FirstUse;
using schedules::synthesis::instants::judging::Prospect;
using schedules::synthesis::plan::Plan;
using schedules::synthesis::plan::PlannedChain;

namespace {

std::size_t first_weighed(const std::vector<double>& weights) {
  return static_cast<std::size_t>(std::find_if(weights.begin(), weights.end(), [](double one) { return one > 0.0; }) -
                                  weights.begin());
}

}  // namespace

ErrorJudge::ErrorJudge(const Plan& plan) {
  TTF_CHECK(plan.error.has_value(), "a plan without plan.error");
  motion_ = plan.error->random_walk ? Motion::kRandomWalk : Motion::kConstantVelocity;
  over_time_ = plan.error->over_time;
  densities_ = plan.error->process_noises;
  for (const PlannedChain& chain : plan.chains) {
    // Odometry has none, and is left out.
    const double sigma = plan.error->sigmas_m[index_of(chain.from)].value_or(1.0);
    variances_.push_back(sigma * sigma);
  }
}

double ErrorJudge::of(const std::vector<ChainEnd>& chain_ends, const std::vector<double>& weights) const {
  std::vector<Round> rounds;
  for (const ChainEnd& chain_end : chain_ends) {
    rounds.push_back({chain_end.round, {}, chain_end.uses, {}});
    if (over_time_) rounds.back().held = {chain_end.round.ns / static_cast<std::int64_t>(chain_end.uses.size())};
    for (const FirstUse& one : chain_end.first_uses)
      rounds.back().sightings.push_back({one.measured, variances_[one.chain], one.used, {}});
  }
  double most = 0.0;
  for (std::size_t i = 0; i < densities_.size(); ++i) {
    if (weights[i] == 0.0) continue;
    double sum = 0.0;
    for (const Round& round : rounds) sum += mean_error(round, motion_, densities_[i]);
    most = std::max(most, weights[i] * sum / static_cast<double>(rounds.size()));
  }
  return most;
}

double ErrorJudge::bound(const std::vector<Prospect>& prospects, const std::vector<double>& weights, double enough,
                         int effort) const {
  double sum = 0.0;
  const auto ends = static_cast<double>(prospects.size());
  for (const Prospect& prospect : prospects) {
    Possible possible{prospect.every, {}, over_time_ ? prospect.every : Duration{}, prospect.attainable};
    for (const Coming& one : prospect.coming)
      possible.streams.push_back({variances_[one.chain], one.period, one.least_age});
    const auto bounded = [&](const Round& round) {
      double most = 0.0;
      for (std::size_t i = 0; i < densities_.size(); ++i)
        if (weights[i] > 0.0) most = std::max(most, weights[i] * bounded_mean_error(round, motion_, densities_[i]));
      return most;
    };
    // The largest part of a sum over ends may be another one at each end. So only one end has the bound of all parts
    // together.
    if (prospects.size() == 1) return least_over_phases(possible, bounded, enough, effort);
    const std::size_t part = first_weighed(weights);
    const auto alone = [&](const Round& round) {
      return weights[part] * bounded_mean_error(round, motion_, densities_[part]);
    };
    sum += least_over_phases(possible, alone, enough * ends, effort) / ends;
  }
  return sum;
}

}  // namespace ttf::experiments::judges
