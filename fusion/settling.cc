#include "fusion/settling.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>

#include "core/check.h"

namespace ttf::fusion {

Settling::Settling(std::vector<Step> steps, Duration round) : steps_(std::move(steps)), round_(round) {
  TTF_CHECK(!steps_.empty() && round_.ns > 0, "{} steps in a round of {} ns", steps_.size(), round_.ns);
  for (std::size_t i = 1; i < steps_.size(); ++i)
    TTF_CHECK(steps_[i - 1].at < steps_[i].at && steps_[i - 1].measured < steps_[i].measured,
              "step {} at {} ns settles {} ns", i, steps_[i].at.ns, steps_[i].measured.ns);
  TTF_CHECK(steps_.back().at < steps_.front().at + round_ &&
                steps_.back().measured < steps_.front().measured + round_,
            "steps of more than a round of {} ns", round_.ns);
}

Settling Settling::after(Duration worst_delay) {
  return {{{GlobalTime{}, GlobalTime{} - worst_delay}}, Duration{1}};
}

GlobalTime Settling::settled(GlobalTime now) const {
  const std::int64_t since = (now - steps_.front().at).ns;
  const std::int64_t rounds = since >= 0 ? since / round_.ns : -((round_.ns - 1 - since) / round_.ns);
  const GlobalTime in_round = now - round_ * rounds;
  // The first step is not after in_round.
  const auto next = std::upper_bound(steps_.begin(), steps_.end(), in_round,
                                     [](GlobalTime t, const Step& step) { return t < step.at; });
  return std::prev(next)->measured + round_ * rounds;
}

}  // namespace ttf::fusion
