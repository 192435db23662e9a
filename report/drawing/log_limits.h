// A damaged or foreign log may hold any number. Values impossible in a drive are dropped before any
// computation. Within these limits differences of times and products with a cycle fit their type.
#pragma once

#include <cstdint>

#include "core/time.h"

namespace ttf::report::drawing {

inline constexpr std::int64_t kMostCycleLines = 2000;                  // in a picture; more lines would hide it
inline constexpr Duration kLongestCycle = Duration::milliseconds(16);  // cCycleMax

// Checks that a time is within 36 years of the drive's start.
constexpr bool possible(std::int64_t ns) {
  constexpr std::int64_t kFarthest_ns = std::int64_t{1} << 60;
  return ns >= -kFarthest_ns && ns <= kFarthest_ns;
}
constexpr bool possible(TrueTime time) { return possible(time.ns); }

// Checks that the cycle, at the longest length, starts within that time.
constexpr bool possible_cycle(std::int64_t cycle) {
  constexpr std::int64_t kMostCycles = std::int64_t{1} << 36;
  return cycle >= -kMostCycles && cycle <= kMostCycles;
}

}  // namespace ttf::report::drawing
