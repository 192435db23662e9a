// The end of a strategy's wait for a missing list.
#include "fusion/strategies/settling.h"

#include <gtest/gtest.h>

#include "tests/fusion/drives.h"

namespace ttf::fusion::strategies {
namespace {

constexpr Duration kNanosecond{1};

TEST(Settling, StepsAtItsInstantsAndRepeats) {
  const Settling settling({{at_ms(6), at_ms(-4)}, {at_ms(16), at_ms(1)}}, Duration::milliseconds(20));
  EXPECT_EQ(settling.settled(at_ms(6)), at_ms(-4));
  EXPECT_EQ(settling.settled(at_ms(16) - kNanosecond), at_ms(-4));
  EXPECT_EQ(settling.settled(at_ms(16)), at_ms(1));
  EXPECT_EQ(settling.settled(at_ms(26) - kNanosecond), at_ms(1));
  EXPECT_EQ(settling.settled(at_ms(26)), at_ms(16));
  EXPECT_EQ(settling.settled(at_ms(2000)), at_ms(1981)) << "the last step was at 16 + 99 * 20";
  // Before the first step too, and before zero.
  EXPECT_EQ(settling.settled(at_ms(6) - kNanosecond), at_ms(-19));
  EXPECT_EQ(settling.settled(at_ms(-14)), at_ms(-24));
  EXPECT_EQ(settling.settled(at_ms(-14) - kNanosecond), at_ms(-39));
}

TEST(Settling, AfterAConstantDelayAtAnyInstant) {
  const Settling settling = Settling::after(Duration::milliseconds(60));
  for (const std::int64_t ns : {-1'000'000'007, -1, 0, 1, 59'999'999, 60'000'000, 1'000'000'007})
    EXPECT_EQ(settling.settled(GlobalTime{ns}).ns, ns - 60'000'000);
}

// settled() reaches an instant at settled_from(), and not a nanosecond before.
TEST(Settling, SaysFromWhenOnSomethingIsSettled) {
  const Settling steps({{at_ms(6), at_ms(-4)}, {at_ms(16), at_ms(1)}}, Duration::milliseconds(20));
  const Settling delay = Settling::after(Duration::milliseconds(60));
  for (const Settling* settling : {&steps, &delay})
    for (std::int64_t us = -100'000; us <= 100'000; us += 500) {
      const GlobalTime measured = at_ms(0) + Duration::microseconds(us), from = settling->settled_from(measured);
      EXPECT_GE(settling->settled(from), measured) << us;
      EXPECT_LT(settling->settled(from - kNanosecond), measured) << us;
    }
}

TEST(SettlingDeath, RefusesWhatIsNoRound) {
  const Duration round = Duration::milliseconds(10);
  EXPECT_DEATH(Settling({}, round), "0 steps");
  EXPECT_DEATH(Settling({{at_ms(0), at_ms(0)}}, Duration{}), "round of 0 ns");
  EXPECT_DEATH(Settling({{at_ms(0), at_ms(0)}, {at_ms(0), at_ms(1)}}, round), "step 1");
  EXPECT_DEATH(Settling({{at_ms(0), at_ms(0)}, {at_ms(1), at_ms(0)}}, round), "step 1");
  EXPECT_DEATH(Settling({{at_ms(0), at_ms(0)}, {at_ms(10), at_ms(1)}}, round), "more than a round");
  EXPECT_DEATH(Settling({{at_ms(0), at_ms(0)}, {at_ms(1), at_ms(10)}}, round), "more than a round");
}

// Sensor 0 has its slots every 10 ms and is read at 6, 16, 26 ms and so on. A read has everything measured 44
// ms before: 2, 12, 22 ms and older at 46, 56, 66.
//
//   t [ms]       0     10    20    30    40    50    60    70
//   settled             -28   -18   -8    2     12    22
//   at                  16    26    36    46    56    66
std::vector<SensorTiming> read_every_10_ms(bool on_schedule) {
  const Settling slots({{at_ms(6), at_ms(-38)}}, Duration::milliseconds(10));
  return {{SensorId{0}, slots, on_schedule, at_ms(2), Duration::milliseconds(80)},
          {SensorId{1}, slots, on_schedule, at_ms(2), Duration::milliseconds(40)}};
}

// The instant at which sensor 1's list is fused while sensor 0 is silent; fusion at 6, 16, 26 ms ...
std::int64_t goes_on_at(StrategyKind kind, GlobalTime measured) {
  const auto strategy = make_strategy(kind, {}, read_every_10_ms(kind == StrategyKind::kTt));
  strategy->accept(list_of(1, 0, measured).view());
  for (std::int64_t now = 6; now < 1000; now += 10) {
    strategy->fuse(at_ms(now));
    if (strategy->last_fused()[0].disposition == Disposition::kFused) return now;
  }
  return -1;
}

TEST(MissingList, BuffGoesOnAtTheStepThatSettlesIt) {
  EXPECT_EQ(goes_on_at(StrategyKind::kBuff, at_ms(2)), 46);
  EXPECT_EQ(goes_on_at(StrategyKind::kBuff, at_ms(2) + kNanosecond), 56) << "one of this stamp may miss 46";
  EXPECT_EQ(goes_on_at(StrategyKind::kBuff, at_ms(12)), 56);
  EXPECT_EQ(goes_on_at(StrategyKind::kBuff, at_ms(12) + kNanosecond), 66);
}

// The list's own stamp does not count. The schedule's instant 2 ms is awaited, regardless of the lists near
// it.
TEST(MissingList, TimeTriggeredGoesOnAtTheStepThatSettlesItsInstant) {
  EXPECT_EQ(goes_on_at(StrategyKind::kTt, at_ms(2)), 46);
  EXPECT_EQ(goes_on_at(StrategyKind::kTt, at_ms(2) + Duration::microseconds(3)), 46);
  EXPECT_EQ(goes_on_at(StrategyKind::kTt, at_ms(42)), 46) << "the silent sensor's last instant is 2 ms";
  EXPECT_EQ(goes_on_at(StrategyKind::kTt, at_ms(82)), 126);
}

}  // namespace
}  // namespace ttf::fusion::strategies
