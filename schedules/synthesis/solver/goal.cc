#include "schedules/synthesis/solver/goal.h"

#include <algorithm>
#include <numeric>

#include "core/check.h"
#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/solver/bounds.h"
#include "schedules/synthesis/solver/model.h"

namespace ttf::schedules::synthesis::solver {
namespace {

Ticks floor_divided(Ticks dividend, Ticks divisor) { return (dividend - modulo(dividend, divisor)) / divisor; }

}  // namespace

Goal::Goal(const Problem& original, const Objective& objective)
    : problem_(original), kind_(objective.kind), which_(objective.which), weights_(objective.weights) {
  const std::size_t all = kind_ == Objective::Kind::kSpan ? original.activities.size() : original.chains.size();
  if (which_.empty()) {
    which_.resize(all);
    std::iota(which_.begin(), which_.end(), std::size_t{0});
  }
  if (weights_.empty()) weights_.assign(which_.size(), 1);
  TTF_CHECK(weights_.size() == which_.size(), "{} weights for {}", weights_.size(), which_.size());
  for (std::size_t at = 0; at < which_.size(); ++at) {
    TTF_CHECK(which_[at] < all, "number {} of {}", which_[at], all);
    TTF_CHECK(weights_[at] > 0, "weight {}", weights_[at]);
  }
  if (kind_ == Objective::Kind::kLateness)
    std::erase_if(which_, [&](std::size_t chain) { return !original.chains[chain].largest_age; });
}

Ticks Goal::value(const Solution& solution) const {
  if (which_.empty()) return 0;
  Ticks value = kind_ == Objective::Kind::kSumOfAges ? 0 : -kNoLimit, first = kNoLimit;
  for (std::size_t at = 0; at < which_.size(); ++at) {
    if (kind_ == Objective::Kind::kSpan) {
      const Ticks offset = solution.offsets[which_[at]];
      first = std::min(first, offset);
      value = std::max(value, offset + problem_.activities[which_[at]].duration);
      continue;
    }
    const Chain& chain = problem_.chains[which_[at]];
    const Ticks old = age(problem_, chain, solution);
    if (kind_ == Objective::Kind::kLargestAge) value = std::max(value, weights_[at] * old);
    if (kind_ == Objective::Kind::kSumOfAges) value += weights_[at] * old;
    if (kind_ == Objective::Kind::kLateness) value = std::max(value, old - *chain.largest_age);
  }
  return kind_ == Objective::Kind::kSpan ? value - first : value;
}

Ticks Goal::least() const {
  if (which_.empty()) return 0;
  Ticks least = kind_ == Objective::Kind::kSumOfAges ? 0 : -kNoLimit;
  for (std::size_t at = 0; at < which_.size(); ++at) {
    if (kind_ == Objective::Kind::kSpan) {
      least = std::max(least, problem_.activities[which_[at]].duration);
      continue;
    }
    const Chain& chain = problem_.chains[which_[at]];
    const Ticks young = least_age_alone(problem_, chain);
    if (kind_ == Objective::Kind::kLargestAge) least = std::max(least, weights_[at] * young);
    if (kind_ == Objective::Kind::kSumOfAges) least += weights_[at] * young;
    if (kind_ == Objective::Kind::kLateness) least = std::max(least, young - *chain.largest_age);
  }
  return least;
}

void Goal::tighten(Tightened& tightened, Ticks most) const {
  if (which_.empty()) return;
  if (kind_ == Objective::Kind::kSpan) tightened.spans.push_back({which_, most});
  if (kind_ == Objective::Kind::kSumOfAges) tightened.sums.push_back({which_, weights_, most});
  if (kind_ != Objective::Kind::kLargestAge && kind_ != Objective::Kind::kLateness) return;
  for (std::size_t at = 0; at < which_.size(); ++at) {
    std::optional<Ticks>& limit = tightened.problem.chains[which_[at]].largest_age;
    const Ticks own = kind_ == Objective::Kind::kLargestAge ? floor_divided(most, weights_[at])
                                                            : *problem_.chains[which_[at]].largest_age + most;
    limit = std::min(own, limit.value_or(own));
  }
}

}  // namespace ttf::schedules::synthesis::solver
