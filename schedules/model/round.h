// The round of a schedule: what every analysis of it goes through, and in which steps.
#pragma once

#include <cstdint>

namespace ttf::schedules::model {

// The cycle counter runs from 0 to gCycleCountMax = 63, and every repetition divides 64: all that the schedule does
// repeats after as many cycles.
inline constexpr std::int64_t kCycles = 64;

// Analyses that look back from an instant begin some rounds in, so that every instant they meet is positive.
inline constexpr std::int64_t kFromCycle = 4 * kCycles;

// Oscillators count whole microticks of at most 50 ns, and a span begins and ends at one.
inline constexpr std::int64_t kGranularity_ns = 2 * 50;

}  // namespace ttf::schedules::model
