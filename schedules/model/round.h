// The round of a schedule: the span and the steps of every analysis.
//
// The cycle counter runs from 0 to gCycleCountMax, and every repetition divides the number of its values: the whole
// schedule repeats after these cycles.
#pragma once

#include <cstdint>

#include "schedules/model/flexray_parameters.h"

namespace ttf::schedules::model {

// A round has 64 cycles at most, and has them in 2.1.
inline constexpr int kMostCycles = 64;

constexpr int cycles_per_round(const GlobalParameters& flexray) { return flexray.gCycleCountMax + 1; }

// Returns the cycle counter in a cycle of any running number.
constexpr int counter_in(const GlobalParameters& flexray, std::int64_t cycle) {
  const std::int64_t round = cycles_per_round(flexray), rest = cycle % round;
  return static_cast<int>(rest < 0 ? rest + round : rest);
}

// Returns the first cycle of analyses that look back from an instant: whole rounds after the start, so that all their
// instants are positive.
constexpr std::int64_t first_analysed(const GlobalParameters& flexray) {
  const std::int64_t round = cycles_per_round(flexray);
  return (4 * kMostCycles + round - 1) / round * round;
}

// Oscillators count whole microticks of at most 50 ns; both ends of a span are rounded to one.
inline constexpr std::int64_t kGranularity_ns = 2 * 50;

}  // namespace ttf::schedules::model
