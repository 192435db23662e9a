#include "fusion/strategies/settling.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>

#include "core/check.h"

namespace ttf::fusion::strategies {
namespace {

std::int64_t floor_of(Duration whole, Duration part) {
  return whole.ns >= 0 ? whole.ns / part.ns : -((part.ns - 1 - whole.ns) / part.ns);
}

}  // namespace

Settling::Settling(std::vector<Step> steps, Duration round) : steps_(std::move(steps)), round_(round) {
  TTF_CHECK(!steps_.empty() && round_.ns > 0, "{} steps in a round of {} ns", steps_.size(), round_.ns);
  for (std::size_t i = 1; i < steps_.size(); ++i)
    TTF_CHECK(steps_[i - 1].at < steps_[i].at && steps_[i - 1].measured < steps_[i].measured,
              "step {} at {} ns settles {} ns", i, steps_[i].at.ns, steps_[i].measured.ns);
  TTF_CHECK(steps_.back().at < steps_.front().at + round_ && steps_.back().measured < steps_.front().measured + round_,
            "steps span more than a round of {} ns", round_.ns);
}

Settling Settling::after(Duration worst_delay) { return {{{GlobalTime{}, GlobalTime{} - worst_delay}}, Duration{1}}; }

GlobalTime Settling::settled(GlobalTime now) const {
  const std::int64_t rounds = floor_of(now - steps_.front().at, round_);
  const GlobalTime in_round = now - round_ * rounds;
  // The first step is not after in_round.
  const auto next = std::upper_bound(steps_.begin(), steps_.end(), in_round,
                                     [](GlobalTime t, const Step& step) { return t < step.at; });
  return std::prev(next)->measured + round_ * rounds;
}

GlobalTime Settling::settled_from(GlobalTime measured) const {
  const std::int64_t rounds = floor_of(measured - steps_.front().measured, round_);
  const GlobalTime in_round = measured - round_ * rounds;
  const auto step = std::lower_bound(steps_.begin(), steps_.end(), in_round,
                                     [](const Step& one, GlobalTime t) { return one.measured < t; });
  return step != steps_.end() ? step->at + round_ * rounds : steps_.front().at + round_ * (rounds + 1);
}

}  // namespace ttf::fusion::strategies
