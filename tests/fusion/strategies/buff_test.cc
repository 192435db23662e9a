// BUFF holds lists back until their order is certain. Timelines: x measured, > arrives at the fusion node;
// fusion every 10 ms.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

#include "tests/fusion/drives.h"

namespace ttf::fusion::strategies {
namespace {

// Worst delays: sensor 0 60 ms, sensor 1 30 ms.
//
//   t [ms]    0     10    20    30    40    50    60    70    80    90    100   110
//   sensor 0  x0 ------------------------------>55           nothing more comes
//   sensor 1        x0 --------->30         x1 ------>65
//   fused                                         0/0   1/0                     1/1
//
// 1/0 (10 ms) arrives at 30, but sensor 0 could still deliver an older list: until 10 + 60 = 70.
// 0/0 ( 0 ms) arrives at 55; sensor 1 has delivered a younger list: fused at 60, at once.
// 1/1 (50 ms): sensor 0 could still deliver until 50 + 60 = 110.
TEST(Buff, WaitsUntilTheOrderIsCertain) {
  const std::vector<SensorTiming> sensors{free_running(0, 60), free_running(1, 30)};
  const auto strategy = make_strategy(StrategyKind::kBuff, {}, sensors);
  const std::vector<Arrival> arrivals{
      {55, list_of(0, 0, at_ms(0))}, {30, list_of(1, 0, at_ms(10))}, {65, list_of(1, 1, at_ms(50))}};
  EXPECT_EQ(run(*strategy, arrivals, 150), (std::vector{fused(60, 0, 0), fused(70, 1, 0), fused(110, 1, 1)}));
}

// The other sensor's list of the same instant settles the order: the smaller sensor first.
//
//   t [ms]    0     10    20    30    40    50    60
//   sensor 0        x0 ------------------>45
//   sensor 1        x0 ------>25
//   fused                                   0/0, 1/0
TEST(Buff, OfOneInstantTheSmallerSensorIsFirst) {
  const std::vector<SensorTiming> sensors{free_running(0, 60), free_running(1, 30)};
  const auto strategy = make_strategy(StrategyKind::kBuff, {}, sensors);
  EXPECT_EQ(run(*strategy, {{45, list_of(0, 0, at_ms(10))}, {25, list_of(1, 0, at_ms(10))}}, 150),
            (std::vector{fused(50, 0, 0), fused(50, 1, 0)}));
}

TEST(Buff, SaysWhenItLetsGoIfNothingArrives) {
  const std::vector<SensorTiming> sensors{free_running(0, 60), free_running(1, 30)};
  config::TrackerConfig fixed, measured;
  fixed.buff_waits = config::BuffWaiting::kFixedLag;
  measured.buff_waits = config::BuffWaiting::kMeasured;
  const std::pair<config::TrackerConfig, std::int64_t> releases[] = {{{}, 70}, {fixed, 110}, {measured, 70}};
  for (const auto& [config, ms] : releases) {
    const auto strategy = make_strategy(StrategyKind::kBuff, config, sensors);
    EXPECT_FALSE(strategy->next_release());
    strategy->accept(list_of(1, 0, at_ms(10)).view());
    strategy->fuse(at_ms(30));
    ASSERT_EQ(held(*strategy), 1u);
    EXPECT_EQ(strategy->next_release(), at_ms(ms));
    strategy->fuse(at_ms(ms) - Duration{1});
    EXPECT_EQ(held(*strategy), 1u);
    strategy->fuse(at_ms(ms));
    EXPECT_EQ(held(*strategy), 0u);
    EXPECT_FALSE(strategy->next_release());
  }
}

// Frequent checks do not lengthen the recorded delay of a waiting list.
TEST(Buff, WaitingIsNoDelay) {
  const std::vector<SensorTiming> sensors{free_running(0, 1000), free_running(1, 1000)};
  config::TrackerConfig config;
  config.buff_waits = config::BuffWaiting::kMeasured;
  const auto strategy = make_strategy(StrategyKind::kBuff, config, sensors);
  strategy->accept(list_of(1, 0, at_ms(0)).view());
  for (int ms = 1; ms <= 600; ++ms) strategy->fuse(at_ms(ms));
  EXPECT_EQ(held(*strategy), 1u);
  strategy->accept(list_of(0, 0, at_ms(600)).view());  // on its way for 1 ms, as sensor 1's was
  strategy->fuse(at_ms(601));
  EXPECT_EQ(held(*strategy), 0u);
}

TEST(Buff, SaysWhatItHolds) {
  const std::vector<SensorTiming> sensors{free_running(0, 60), free_running(1, 30)};
  const auto strategy = make_strategy(StrategyKind::kBuff, {}, sensors);
  strategy->accept(list_of(1, 0, at_ms(10)).view());
  strategy->fuse(at_ms(30));
  ASSERT_EQ(strategy->last_fused().size(), 1u);
  EXPECT_EQ(strategy->last_fused()[0].disposition, Disposition::kHeld);
  EXPECT_EQ(strategy->last_fused()[0].measured, at_ms(10));
  EXPECT_TRUE(strategy->newest().empty());
}

// For a silent sensor, to the nanosecond.
TEST(Buff, LetsGoWhenNothingOlderCanArriveAnyMore) {
  const auto strategy = make_strategy(StrategyKind::kBuff, {}, std::vector{free_running(0, 60), free_running(1, 30)});
  strategy->accept(list_of(1, 0, at_ms(20)).view());
  strategy->fuse(at_ms(80) - Duration{1});
  EXPECT_EQ(held(*strategy), 1u);
  strategy->fuse(at_ms(80));
  EXPECT_EQ(held(*strategy), 0u);
}

// A list of sensor 0 comes after the 60 ms in which it settles:
//
//   t [ms]    0     10    20    30    40    50    60    70    80    90
//   sensor 0  x0 ------------------------------------------------>85
//   sensor 1        x0 --------->30
//   fused                                               1/0         0/0 late
TEST(Buff, RepairsAListThatComesAfterItsInstantWasSettled) {
  const std::vector<SensorTiming> sensors{free_running(0, 60), free_running(1, 30)};
  const auto strategy = make_strategy(StrategyKind::kBuff, {}, sensors);
  EXPECT_EQ(run(*strategy, {{85, list_of(0, 0, at_ms(0))}, {30, list_of(1, 0, at_ms(10))}}, 150),
            (std::vector{fused(70, 1, 0), fused(90, 0, 0, Disposition::kFusedLate)}));
}

// 25 ms after every measurement, at the next fusion instant, regardless of arrivals.
//
//   t [ms]    0     10    20    30    40    50    60
//   sensor 0  x0 ------------------------------>55
//   sensor 1        x0 --------->30
//   fused                             1/0       0/0 late
TEST(Buff, WithAFixedLagWaitsNoLongerAndRepairsWhatComesLater) {
  const std::vector<SensorTiming> sensors{free_running(0, 60), free_running(1, 30)};
  config::TrackerConfig config;
  config.buff_waits = config::BuffWaiting::kFixedLag;
  config.fixed_lag = Duration::milliseconds(25);
  const auto strategy = make_strategy(StrategyKind::kBuff, config, sensors);
  EXPECT_EQ(run(*strategy, {{55, list_of(0, 0, at_ms(0))}, {30, list_of(1, 0, at_ms(10))}}, 150),
            (std::vector{fused(40, 1, 0), fused(60, 0, 0, Disposition::kFusedLate)}));
}

// Sensor 0 may take 60 ms, but its first list took 20, as fusion instants see it. From then on no list waits
// longer. Once one takes 50, that counts.
//
//   t [ms]    0     10    20    30    40    50    60    70    80   ...  100   110   120   130   140   150   160
//   sensor 0  x0 --------->15         x1 ------------------------------>85
//   sensor 1        x0 ->15                 x1 ->55                           x2 ->115
//   fused                 0/0   1/0               .           1/1        0/1 late                      1/2
TEST(Buff, WithMeasuredDelaysWaitsForTheLongestSoFar) {
  const std::vector<SensorTiming> sensors{free_running(0, 60), free_running(1, 30)};
  config::TrackerConfig config;
  config.buff_waits = config::BuffWaiting::kMeasured;
  const auto strategy = make_strategy(StrategyKind::kBuff, config, sensors);
  EXPECT_EQ(run(*strategy,
                {{15, list_of(0, 0, at_ms(0))},
                 {15, list_of(1, 0, at_ms(10))},
                 {85, list_of(0, 1, at_ms(40))},
                 {55, list_of(1, 1, at_ms(50))},
                 {115, list_of(1, 2, at_ms(110))}},
                250),
            (std::vector{fused(20, 0, 0), fused(30, 1, 0), fused(70, 1, 1), fused(90, 0, 1, Disposition::kFusedLate),
                         fused(160, 1, 2)}));
}

// Any drive with delays below the worst: released in chronological order, never late, no later than the worst
// delay.
TEST(Buff, IsInOrderAndNeverWaitsLongerThanTheWorstDelay) {
  const std::int64_t worst[] = {120, 45, 80}, period[] = {80, 42, 55};
  const std::vector<SensorTiming> sensors{free_running(0, worst[0]), free_running(1, worst[1]),
                                          free_running(2, worst[2])};
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    RandomStream stream({.seed = seed});
    std::vector<Arrival> arrivals;
    std::map<MeasurementId, std::pair<std::int64_t, std::int64_t>> measured_arrived;
    for (std::uint8_t s = 0; s < 3; ++s) {
      std::int64_t before_this = 0;
      for (std::uint32_t k = 0; k < 20; ++k) {
        const std::int64_t t = 7 * s + period[s] * k;
        before_this = std::max(before_this, t + stream.integer(5, worst[s]));
        arrivals.push_back({before_this, list_of(s, k, at_ms(t))});
        measured_arrived[arrivals.back().list.id] = {t, before_this};
      }
    }
    const auto strategy = make_strategy(StrategyKind::kBuff, {}, sensors);
    const std::vector<Fused> result = run(*strategy, arrivals, 2500);
    ASSERT_EQ(result.size(), arrivals.size());
    std::pair<std::int64_t, MeasurementId> last{-1, {}};
    for (const Fused& f : result) {
      ASSERT_EQ(f.disposition, Disposition::kFused);
      const auto [t, arrived] = measured_arrived[f.id];
      ASSERT_LT(last, (std::pair{t, f.id}));
      last = {t, f.id};
      ASSERT_LT(f.ms, std::max(arrived, t + 120) + 10);
    }
  }
}

}  // namespace
}  // namespace ttf::fusion::strategies
