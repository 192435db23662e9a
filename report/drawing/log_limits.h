// A damaged or foreign log may say anything. What no run can have is left out before it is computed with: up to these
// limits, differences of times and products with a cycle fit their type.
#pragma once

#include <cstdint>

#include "core/time.h"

namespace ttf::report::drawing {

inline constexpr std::int64_t kMostCycleLines = 2000;                  // in a picture: more are no grid any more
inline constexpr Duration kLongestCycle = Duration::milliseconds(16);  // cCycleMax

// Within 36 years of the run's start.
constexpr bool possible(std::int64_t ns) {
  constexpr std::int64_t kFarthest_ns = std::int64_t{1} << 60;
  return ns >= -kFarthest_ns && ns <= kFarthest_ns;
}
constexpr bool possible(TrueTime time) { return possible(time.ns); }

// As many cycles of the longest as go into that time.
constexpr bool possible_cycle(std::int64_t cycle) {
  constexpr std::int64_t kMostCycles = std::int64_t{1} << 36;
  return cycle >= -kMostCycles && cycle <= kMostCycles;
}

}  // namespace ttf::report::drawing
