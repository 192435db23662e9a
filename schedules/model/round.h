// The round of a schedule: the span and the steps of every analysis.
#pragma once

#include <cstdint>

namespace ttf::schedules::model {

// The cycle counter runs from 0 to gCycleCountMax = 63, and every repetition divides 64: the whole schedule
// repeats after this many cycles.
inline constexpr std::int64_t kCycles = 64;

// Analyses that look back from an instant start some rounds late, so that all their instants are positive.
inline constexpr std::int64_t kFromCycle = 4 * kCycles;

// Oscillators count whole microticks of at most 50 ns; both ends of a span are rounded to one.
inline constexpr std::int64_t kGranularity_ns = 2 * 50;

}  // namespace ttf::schedules::model
