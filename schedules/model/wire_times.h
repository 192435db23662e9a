// The terms of the constraints of FlexRay 2.1A, annex B: longest times on the wire, shortest macroticks and the
// assumed precision of clocks. All are integers in picoseconds; times to be compared are scaled so that
// cClockDeviationMax is whole.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/int128.h"
#include "core/time.h"
#include "schedules/model/flexray_parameters.h"

namespace ttf::schedules::model {

// cClockDeviationMax = 0.0015, in parts of 10000; cChannelIdleDelimiter in gdBit.
inline constexpr std::int64_t kDeviation = 15, kWhole = 10'000;
inline constexpr std::int64_t kIdleDelimiterBits = 11;

// a, b > 0.
constexpr std::int64_t ceil_div(Int128 a, Int128 b) { return static_cast<std::int64_t>((a + b - 1) / b); }

// Returns picoseconds times kWhole.
constexpr Int128 longest_bits(const GlobalParameters& flexray, std::int64_t bits) {
  return static_cast<Int128>(bits) * flexray.gdBit_ps * (kWhole + kDeviation);
}
constexpr Int128 scaled(std::int64_t ps) { return static_cast<Int128>(ps) * kWhole; }
constexpr Int128 shortest_macroticks(const GlobalParameters& flexray, std::int64_t macroticks) {
  return static_cast<Int128>(macroticks) * flexray.gdMacrotick_ps * (kWhole - kDeviation);
}

// gAssumedPrecision = (34 + 20 gClusterDriftDamping) gdMaxMicrotick + 2 gdMaxPropagationDelay, in picoseconds.
constexpr std::int64_t assumed_precision_ps(const GlobalParameters& flexray) {
  return (34 + 20 * static_cast<std::int64_t>(flexray.gClusterDriftDamping)) * flexray.gdMaxMicrotick_ps +
         2 * flexray.gdMaxPropagationDelay_ps;
}
// Rounds up to whole nanoseconds: two clock readings that differ by more do so however they were rounded.
constexpr Duration assumed_precision(const GlobalParameters& flexray) {
  return {ceil_div(assumed_precision_ps(flexray), 1000)};
}

// adActionPointDifference: makes the first action point of the dynamic segment no earlier in it than that of a
// static slot.
constexpr int action_point_difference(const GlobalParameters& flexray) {
  return flexray.gNumberOfMinislots == 0
             ? 0
             : std::max(0, flexray.gdActionPointOffset - flexray.gdMinislotActionPointOffset);
}

}  // namespace ttf::schedules::model
