// Wake-up patterns as a receiver makes them out.
#include "bus/wire/symbols.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace ttf::bus::wire {
namespace {

// At 10 Mbit/s: low for 6 us, idle for 18 us.
constexpr Duration kSymbol = Duration::microseconds(24);

TEST(WakeupSymbols, APatternAloneWakes) { EXPECT_TRUE(wakes({})); }

TEST(WakeupSymbols, OneSymbolDoesNot) {
  EXPECT_FALSE(wakes({}, std::array{WakeupPattern{{}, kSymbol}}));
  EXPECT_TRUE(wakes({}, std::array{WakeupPattern{{}, 2 * kSymbol}}));
  EXPECT_FALSE(wakes({}, {}));
}

// Each of the receiver's parameters, at its limit and one bit beyond it.
TEST(WakeupSymbols, TheReceiversParametersBoundThePhases) {
  const auto with = [](int schedules::model::GlobalParameters::*parameter, int value) {
    schedules::model::GlobalParameters flexray;
    flexray.*parameter = value;
    return wakes(flexray);
  };
  using G = schedules::model::GlobalParameters;
  EXPECT_TRUE(with(&G::gdWakeupSymbolRxLow, 60));
  EXPECT_FALSE(with(&G::gdWakeupSymbolRxLow, 61));
  EXPECT_TRUE(with(&G::gdWakeupSymbolRxIdle, 180));
  EXPECT_FALSE(with(&G::gdWakeupSymbolRxIdle, 181));
  EXPECT_TRUE(with(&G::gdWakeupSymbolRxWindow, 240 + 55));
  EXPECT_FALSE(with(&G::gdWakeupSymbolRxWindow, 240 + 54));
}

// Two overlapping patterns wake at any shift. Halfway, no idle phase is longer than 60 bits.
TEST(WakeupSymbols, TwoThatOverlapWakeAtAnyShift) {
  for (std::int64_t ns = 0; ns <= 2 * kSymbol.ns; ns += 50)
    for (const std::int64_t ppm : {-3000, 0, 3000}) {
      const Duration shift{ns}, length{2 * kSymbol.ns * (1'000'000 + ppm) / 1'000'000};
      EXPECT_TRUE(wakes({}, std::array{WakeupPattern{{}, 2 * kSymbol}, WakeupPattern{shift, shift + length}}))
          << ns << " ns, " << ppm << " ppm";
    }
  schedules::model::GlobalParameters needs_longer_idle;
  needs_longer_idle.gdWakeupSymbolRxIdle = 61;
  const Duration half = Duration::microseconds(12);
  EXPECT_FALSE(
      wakes(needs_longer_idle, std::array{WakeupPattern{{}, 2 * kSymbol}, WakeupPattern{half, half + 2 * kSymbol}}));
}

// Four nodes can fill each other's idle phases: then the bus is low without a pause.
TEST(WakeupSymbols, FourMayNotWake) {
  std::vector<WakeupPattern> patterns;
  for (int node = 0; node < 4; ++node) {
    const Duration shift = Duration::microseconds(6 * node);
    patterns.push_back({shift, shift + 2 * kSymbol});
  }
  EXPECT_FALSE(wakes({}, patterns));
}

}  // namespace
}  // namespace ttf::bus::wire
