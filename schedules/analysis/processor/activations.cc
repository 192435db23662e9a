#include "schedules/analysis/processor/activations.h"

#include <algorithm>

namespace ttf::schedules::analysis::processor {

std::int64_t ActivationBounds::most(std::int64_t window_ns) const {
  std::optional<std::int64_t> least;
  for (const ActivationBound& one : all) {
    const std::int64_t times = (window_ns + one.jitter) / one.period + 1;
    least = std::min(least.value_or(times), times);
  }
  return least.value_or(1);
}

std::optional<std::int64_t> ActivationBounds::gap() const {
  std::optional<std::int64_t> longest;
  for (const ActivationBound& one : all) longest = std::max(longest.value_or(0), one.period - one.jitter);
  return longest;
}

}  // namespace ttf::schedules::analysis::processor
