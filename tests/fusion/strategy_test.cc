// When each strategy fuses what. Timelines: x measured, > arrives at the fusion node; fusion every 10 ms.
#include "fusion/strategy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "fusion/timeline.h"
#include "tests/fusion/scenes.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion {
namespace {

constexpr auto milliseconds = [](std::int64_t n) { return Duration::milliseconds(n); };

SensorTiming free_running(std::uint8_t sensor, std::int64_t worst_ms) {
  return {static_cast<SensorId>(sensor), milliseconds(worst_ms), false, {}, {}};
}
SensorTiming scheduled(std::uint8_t sensor, std::int64_t worst_ms, std::int64_t first_ms,
                       std::int64_t period_ms) {
  return {static_cast<SensorId>(sensor), milliseconds(worst_ms), true, at_ms(first_ms),
          milliseconds(period_ms)};
}

struct Arrival {
  std::int64_t ms = 0;
  OwnedScan scan;
};
struct Fused {
  std::int64_t ms = 0;
  MeasurementId id;
  Disposition disposition = Disposition::kFused;
  bool operator==(const Fused&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Fused& f) {
  return out << "{" << f.ms << " ms: " << index_of(f.id.sensor) << "/" << f.id.sequence << " "
             << static_cast<int>(f.disposition) << "}";
}
Fused fused(std::int64_t ms, std::uint8_t sensor, std::uint32_t sequence,
            Disposition d = Disposition::kFused) {
  return {ms, {static_cast<SensorId>(sensor), sequence}, d};
}

// Fusion every 10 ms until `until`; what was reported, waiting ones left out.
std::vector<Fused> run(Strategy& strategy, std::vector<Arrival> arrivals, std::int64_t until) {
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const Arrival& a, const Arrival& b) { return a.ms < b.ms; });
  std::vector<Fused> out;
  std::size_t next = 0;
  for (std::int64_t now = 0; now <= until; now += 10) {
    for (; next < arrivals.size() && arrivals[next].ms <= now; ++next)
      strategy.accept(arrivals[next].scan.view());
    strategy.fuse(at_ms(now));
    for (const FusedScan& f : strategy.last_fused())
      if (f.disposition != Disposition::kHeld) out.push_back({now, f.id, f.disposition});
  }
  return out;
}

std::size_t held(const Strategy& strategy) {
  return static_cast<std::size_t>(
      std::count_if(strategy.last_fused().begin(), strategy.last_fused().end(),
                    [](const FusedScan& f) { return f.disposition == Disposition::kHeld; }));
}

// sensor 0 (worst delay 60)  x0 ---------------------> 55                                     nothing more
// comes sensor 1 (worst delay 30)     x10 ---> 30      x50 -> 65 fusion                        10  20  30  40
// 50  60  70  80  90  100  110
//   1/0 (10 ms) is there at 30, but sensor 0 could still deliver something older: until 10 + 60 = 70.
//   0/0 ( 0 ms) is there at 55; sensor 1 has delivered something younger: fused at 60, at once.
//   1/1 (50 ms): sensor 0 could still deliver until 50 + 60 = 110.
TEST(Buff, WaitsUntilTheOrderIsCertain) {
  const std::vector<SensorTiming> sensors{free_running(0, 60), free_running(1, 30)};
  const auto strategy = make_strategy(StrategyKind::kBuff, {}, sensors);
  const std::vector<Arrival> arrivals{
      {55, scan(0, 0, at_ms(0))}, {30, scan(1, 0, at_ms(10))}, {65, scan(1, 1, at_ms(50))}};
  EXPECT_EQ(run(*strategy, arrivals, 150), (std::vector{fused(60, 0, 0), fused(70, 1, 0), fused(110, 1, 1)}));
}

// sensor 0 (worst delay 60)      x10 -----------------> 45
// sensor 1 (worst delay 30)      x10 ---> 25
//   A scan of the same instant from the other sensor settles the order: the smaller sensor first.
TEST(Buff, OfOneInstantTheSmallerSensorIsFirst) {
  const std::vector<SensorTiming> sensors{free_running(0, 60), free_running(1, 30)};
  const auto strategy = make_strategy(StrategyKind::kBuff, {}, sensors);
  EXPECT_EQ(run(*strategy, {{45, scan(0, 0, at_ms(10))}, {25, scan(1, 0, at_ms(10))}}, 150),
            (std::vector{fused(50, 0, 0), fused(50, 1, 0)}));
}

TEST(Buff, SaysWhatItHolds) {
  const std::vector<SensorTiming> sensors{free_running(0, 60), free_running(1, 30)};
  const auto strategy = make_strategy(StrategyKind::kBuff, {}, sensors);
  strategy->accept(scan(1, 0, at_ms(10)).view());
  strategy->fuse(at_ms(30));
  ASSERT_EQ(strategy->last_fused().size(), 1u);
  EXPECT_EQ(strategy->last_fused()[0].disposition, Disposition::kHeld);
  EXPECT_EQ(strategy->last_fused()[0].measured, at_ms(10));
  EXPECT_TRUE(strategy->newest().empty());
}

// sensor 0 breaks its promise of 60 ms: 0/0 comes after 85.
TEST(Buff, RepairsABrokenPromise) {
  const std::vector<SensorTiming> sensors{free_running(0, 60), free_running(1, 30)};
  const auto strategy = make_strategy(StrategyKind::kBuff, {}, sensors);
  EXPECT_EQ(run(*strategy, {{85, scan(0, 0, at_ms(0))}, {30, scan(1, 0, at_ms(10))}}, 150),
            (std::vector{fused(70, 1, 0), fused(90, 0, 0, Disposition::kFusedLate)}));
}

// Any drive that keeps its promises: released in chronological order, never late, and no later than the last
// promise.
TEST(Buff, IsInOrderAndNeverWaitsLongerThanTheWorstDelay) {
  const std::vector<SensorTiming> sensors{free_running(0, 120), free_running(1, 45), free_running(2, 80)};
  const std::int64_t period[] = {80, 42, 55};
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    RandomStream stream({.seed = seed});
    std::vector<Arrival> arrivals;
    std::map<MeasurementId, std::pair<std::int64_t, std::int64_t>> measured_arrived;
    for (std::uint8_t s = 0; s < 3; ++s) {
      std::int64_t before_this = 0;
      for (std::uint32_t k = 0; k < 20; ++k) {
        const std::int64_t t = 7 * s + period[s] * k;
        before_this = std::max(before_this, t + stream.integer(5, sensors[s].worst_delay.ns / 1'000'000));
        arrivals.push_back({before_this, scan(s, k, at_ms(t))});
        measured_arrived[arrivals.back().scan.id] = {t, before_this};
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

// The same drive as the first: everything at the fusion instant after its arrival, the older one as late.
TEST(Adva, FusesOnArrival) {
  const std::vector<SensorTiming> sensors{free_running(0, 60), free_running(1, 30)};
  const auto strategy = make_strategy(StrategyKind::kAdva, {}, sensors);
  const std::vector<Arrival> arrivals{
      {55, scan(0, 0, at_ms(0))}, {30, scan(1, 0, at_ms(10))}, {65, scan(1, 1, at_ms(50))}};
  EXPECT_EQ(run(*strategy, arrivals, 150),
            (std::vector{fused(30, 1, 0), fused(60, 0, 0, Disposition::kFusedLate), fused(70, 1, 1)}));
}

TEST(Adva, WhatArrivesTogetherIsFusedInOrder) {
  const auto strategy =
      make_strategy(StrategyKind::kAdva, {}, std::vector{free_running(0, 60), free_running(1, 30)});
  EXPECT_EQ(run(*strategy, {{25, scan(1, 0, at_ms(10))}, {25, scan(0, 0, at_ms(0))}}, 50),
            (std::vector{fused(30, 0, 0), fused(30, 1, 0)}));
}

TEST(Adva, OlderThanTheHistoryIsDropped) {
  TrackerConfig config;
  config.history_scans = 2;
  const auto strategy = make_strategy(StrategyKind::kAdva, config, std::vector{free_running(0, 60)});
  std::vector<Arrival> arrivals;
  for (std::uint32_t k = 1; k <= 4; ++k) arrivals.push_back({10 * k, scan(0, k, at_ms(10 * k))});
  arrivals.push_back({60, scan(0, 0, at_ms(0))});
  EXPECT_EQ(run(*strategy, arrivals, 60).back(), fused(60, 0, 0, Disposition::kDroppedTooOld));
  ASSERT_EQ(strategy->newest().size(), 1u);
  EXPECT_EQ(strategy->newest()[0].sequence, 4u);
}

// laser  (80 ms from 0, worst delay 60)    x0 --------------> 50                x80
// camera (40 ms from 20, worst delay 35)        x20 ---> 45      x60 ---> 85
//   camera 0 (20 ms) waits for the laser's 0 ms, which is due at 60 and comes at 50: both then. BUFF would
//   wait for what the schedule says cannot come, until 20 + 60 = 80. camera 1 (60 ms) waits for nobody: the
//   laser's next instant is younger.
const std::vector<SensorTiming> kSchedule{scheduled(0, 60, 0, 80), scheduled(1, 35, 20, 40)};

TEST(TimeTriggered, WaitsOnlyForWhatIsOnTheSchedule) {
  const std::vector<Arrival> arrivals{
      {50, scan(0, 0, at_ms(0))}, {45, scan(1, 0, at_ms(20))}, {85, scan(1, 1, at_ms(60))}};
  const auto tt = make_strategy(StrategyKind::kTt, {}, kSchedule);
  EXPECT_EQ(run(*tt, arrivals, 200), (std::vector{fused(50, 0, 0), fused(50, 1, 0), fused(90, 1, 1)}));
  const auto buff = make_strategy(StrategyKind::kBuff, {}, kSchedule);
  EXPECT_EQ(run(*buff, arrivals, 200), (std::vector{fused(50, 0, 0), fused(80, 1, 0), fused(120, 1, 1)}));
}

// laser    x0 (lost)          due 60
// camera        x20 ---> 45
TEST(TimeTriggered, DoesNotWaitForAMissingScanBeyondItsDueInstant) {
  const auto strategy = make_strategy(StrategyKind::kTt, {}, kSchedule);
  EXPECT_EQ(run(*strategy, {{45, scan(1, 0, at_ms(20))}}, 200), (std::vector{fused(60, 1, 0)}));
}

// laser    x0 ------------------------------> 75 (due 60)
// camera        x20 ---> 45
TEST(TimeTriggered, RepairsABrokenPromise) {
  const Lanes lanes{.objects = 3};
  const OwnedScan laser = scan(0, 0, at_ms(0), lanes.see(at_ms(0), 0)),
                  camera = scan(1, 0, at_ms(20), lanes.see(at_ms(20), 1));
  const auto strategy = make_strategy(StrategyKind::kTt, {}, kSchedule),
             in_order = make_strategy(StrategyKind::kTt, {}, kSchedule);
  EXPECT_EQ(run(*strategy, {{75, laser}, {45, camera}}, 100),
            (std::vector{fused(60, 1, 0), fused(80, 0, 0, Disposition::kFusedLate)}));
  run(*in_order, {{45, laser}, {45, camera}}, 100);
  EXPECT_EQ(strategy->tentative_count(), 3);
  EXPECT_EQ(strategy->newest_measured(), at_ms(20));
  // Confirm both with the same further scans: the images must be the same to the last bit.
  std::vector<TrackView> image[2];
  int i = 0;
  for (Strategy* s : {strategy.get(), in_order.get()}) {
    for (std::uint32_t k = 1; k <= 3; ++k)
      s->accept(scan(1, k, at_ms(20 + 40 * k), lanes.see(at_ms(20 + 40 * k), k)).view());
    s->fuse(at_ms(500));
    s->image(at_ms(500), image[i++]);
  }
  EXPECT_EQ(image[0].size(), 3u);
  EXPECT_TRUE(same_bits(image[0], image[1]));
}

// Stamps are clock readings. Both measure at 40 ms; the camera stamps 39.997 and arrives first, the
// laser 39.995.
//   By its stamp alone the camera would have no scheduled predecessor, and the laser would come late.
TEST(TimeTriggered, SensorsOfOneInstantWaitForEachOtherWhateverTheStamps) {
  const std::vector<SensorTiming> together{scheduled(0, 60, 0, 40), scheduled(1, 35, 0, 40)};
  const GlobalTime laser_stamp{39'995'000}, camera_stamp{39'997'000};
  const auto strategy = make_strategy(StrategyKind::kTt, {}, together);
  EXPECT_EQ(run(*strategy,
                {{25, scan(0, 0, at_ms(0))},
                 {25, scan(1, 0, at_ms(0))},
                 {60, scan(1, 1, camera_stamp)},
                 {90, scan(0, 1, laser_stamp)}},
                200),
            (std::vector{fused(30, 0, 0), fused(30, 1, 0), fused(90, 0, 1), fused(90, 1, 1)}));
  // The laser's is lost: not beyond 40 + 60.
  const auto without = make_strategy(StrategyKind::kTt, {}, together);
  EXPECT_EQ(run(*without, {{60, scan(1, 1, camera_stamp)}}, 200), (std::vector{fused(100, 1, 1)}));
}

// An instant of the schedule is recognised though the stamp is a little early or late.
TEST(TimeTriggered, RecognisesInstantsByStampsThatAreALittleOff) {
  for (const std::int64_t off_ns : {-300'000, 0, 300'000}) {
    const auto strategy = make_strategy(StrategyKind::kTt, {}, kSchedule);
    EXPECT_EQ(
        run(*strategy, {{30, scan(0, 0, at_ms(0) + Duration{off_ns})}, {45, scan(1, 0, at_ms(20))}}, 200),
        (std::vector{fused(30, 0, 0), fused(50, 1, 0)}));
  }
}

// Before a sensor's first instant there is nothing to wait for.
TEST(TimeTriggered, TheScheduleHasABeginning) {
  const auto strategy =
      make_strategy(StrategyKind::kTt, {}, std::vector{scheduled(0, 60, 100, 80), scheduled(1, 35, 20, 40)});
  EXPECT_EQ(run(*strategy, {{45, scan(1, 0, at_ms(20))}}, 200), (std::vector{fused(50, 1, 0)}));
}

class EveryStrategy : public testing::TestWithParam<StrategyKind> {};
std::string name_of(const testing::TestParamInfo<StrategyKind>& kind) {
  switch (kind.param) {
    case StrategyKind::kBuff:
      return "Buff";
    case StrategyKind::kAdva:
      return "Adva";
    case StrategyKind::kTt:
      return "Tt";
  }
  return "";
}
INSTANTIATE_TEST_SUITE_P(All, EveryStrategy,
                         testing::Values(StrategyKind::kBuff, StrategyKind::kAdva, StrategyKind::kTt),
                         name_of);

// Two sensors on a schedule, with delays up to their worst, so that many arrive out of order.
std::vector<Arrival> drive(std::uint64_t seed, std::uint32_t laser_scans) {
  RandomStream stream({.seed = seed});
  const Lanes laser{.miss_probability = 0.05, .seed = seed},
      camera{.sigma = 0.4, .miss_probability = 0.1, .seed = seed + 1000};
  std::vector<Arrival> arrivals;
  for (std::uint32_t k = 0; k < laser_scans; ++k)
    arrivals.push_back(
        {80 * k + stream.integer(30, 60), scan(0, k, at_ms(80 * k), laser.see(at_ms(80 * k), k))});
  for (std::uint32_t k = 0; k < 2 * laser_scans; ++k)
    arrivals.push_back({20 + 40 * k + stream.integer(5, 35),
                        scan(1, k, at_ms(20 + 40 * k), camera.see(at_ms(20 + 40 * k), k))});
  return arrivals;
}

TEST_P(EveryStrategy, EndsWithTheBitsOfInOrderProcessing) {
  const std::vector<Arrival> arrivals = drive(1, 40);
  const auto strategy = make_strategy(GetParam(), {}, kSchedule);
  const std::vector<Fused> result = run(*strategy, arrivals, 3500);
  EXPECT_EQ(result.size(), arrivals.size());
  const auto late = std::count_if(result.begin(), result.end(),
                                  [](const Fused& f) { return f.disposition == Disposition::kFusedLate; });
  if (GetParam() == StrategyKind::kAdva)
    EXPECT_GT(late, 5);
  else
    EXPECT_EQ(late, 0) << "all promises were kept";

  std::vector<OwnedScan> in_order;
  for (const Arrival& a : arrivals) in_order.push_back(a.scan);
  std::sort(in_order.begin(), in_order.end(), [](const OwnedScan& a, const OwnedScan& b) {
    return before(a.id, a.measured, b.id, b.measured);
  });
  Timeline timeline(TrackerConfig{}, kMaxObservations);
  for (const OwnedScan& s : in_order) timeline.insert(s.view());
  std::vector<TrackView> expected, image;
  for (const Track& track : timeline.current().tracks)
    if (track.confirmed)
      expected.push_back(view_of(track, timeline.current().time, at_ms(3300), TrackerConfig{}));
  strategy->image(at_ms(3300), image);
  EXPECT_EQ(image.size(), 25u);
  EXPECT_TRUE(same_bits(image, expected));
  EXPECT_EQ(strategy->confirmed_count(), 25);
  EXPECT_EQ(strategy->newest_measured(), in_order.back().measured);
  ASSERT_EQ(strategy->newest().size(), 2u);
  for (const MeasurementId& id : strategy->newest())
    EXPECT_EQ(id.sequence, id.sensor == SensorId{0} ? 39u : 79u);
}

TEST_P(EveryStrategy, AnImageLeavesNoTrace) {
  const auto looked_at = make_strategy(GetParam(), {}, kSchedule),
             undisturbed = make_strategy(GetParam(), {}, kSchedule);
  std::vector<Arrival> arrivals = drive(2, 10);
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const Arrival& a, const Arrival& b) { return a.ms < b.ms; });
  std::size_t next = 0;
  std::vector<TrackView> image, again, others;
  for (std::int64_t now = 0; now <= 900; now += 10) {
    for (; next < arrivals.size() && arrivals[next].ms <= now; ++next) {
      looked_at->accept(arrivals[next].scan.view());
      undisturbed->accept(arrivals[next].scan.view());
    }
    looked_at->fuse(at_ms(now));
    undisturbed->fuse(at_ms(now));
    looked_at->image(at_ms(now + 40), image);
    looked_at->image(at_ms(now + 5000), others);
    looked_at->image(at_ms(0), others);
    looked_at->image(at_ms(now + 40), again);
    ASSERT_TRUE(same_bits(image, again));
    ASSERT_TRUE(same_bits({looked_at->tracks().begin(), looked_at->tracks().end()},
                          {undisturbed->tracks().begin(), undisturbed->tracks().end()}));
  }
  EXPECT_EQ(image.size(), 25u);
  undisturbed->image(at_ms(940), others);
  EXPECT_TRUE(same_bits(image, others));
}

TEST_P(EveryStrategy, ADuplicateIsReportedAndChangesNothing) {
  const auto once = make_strategy(GetParam(), {}, kSchedule),
             twice = make_strategy(GetParam(), {}, kSchedule);
  std::vector<Arrival> arrivals = drive(3, 6), repeated = arrivals;
  for (const Arrival& a : arrivals) {
    repeated.push_back(a);                     // at once, while it may still wait
    repeated.push_back({a.ms + 100, a.scan});  // when it is long fused
  }
  const std::size_t count = run(*once, arrivals, 1000).size();
  const std::vector<Fused> result = run(*twice, repeated, 1000);
  EXPECT_EQ(result.size(), 3 * count);
  EXPECT_EQ(static_cast<std::size_t>(
                std::count_if(result.begin(), result.end(),
                              [](const Fused& f) { return f.disposition == Disposition::kDuplicate; })),
            2 * count);
  std::vector<TrackView> a, b;
  once->image(at_ms(1000), a);
  twice->image(at_ms(1000), b);
  EXPECT_FALSE(a.empty());
  EXPECT_TRUE(same_bits(a, b));
}

TEST_P(EveryStrategy, AStampFromTheFutureWaitsForItsTime) {
  const auto strategy = make_strategy(GetParam(), {}, kSchedule);
  strategy->accept(scan(0, 0, at_ms(0), {position(10.0, 0.0, 0.1)}).view());
  strategy->accept(scan(0, 1, at_ms(30'000), {position(10.0, 0.0, 0.1)}).view());
  strategy->fuse(at_ms(100));
  EXPECT_EQ(held(*strategy), 1u);
  EXPECT_EQ(strategy->newest_measured(), at_ms(0));
  EXPECT_EQ(strategy->tentative_count(), 1);
}

TEST_P(EveryStrategy, MoreThanCanWaitIsFusedOldestFirst) {
  // Sensor 1 is silent and would be waited for until 20 s are over.
  const std::vector<SensorTiming> sensors{free_running(0, 20), scheduled(1, 20'000, 0, 40)};
  const auto strategy = make_strategy(GetParam(), {}, sensors);
  const auto many = static_cast<std::uint32_t>(kMaxPending + 8);
  for (std::uint32_t k = 0; k < many; ++k) strategy->accept(scan(0, k, at_ms(k)).view());
  strategy->fuse(at_ms(100));
  EXPECT_EQ(strategy->last_fused().size(), many) << "each is accounted for";
  EXPECT_EQ(held(*strategy), GetParam() == StrategyKind::kAdva ? 0u : kMaxPending);
  for (std::size_t i = 0; i < many; ++i) EXPECT_EQ(strategy->last_fused()[i].id.sequence, i);
  strategy->fuse(at_ms(30'000));
  EXPECT_EQ(held(*strategy), 0u);
  EXPECT_EQ(strategy->newest()[0].sequence, many - 1);
}

TEST_P(EveryStrategy, AllocatesNothingAfterConstruction) {
  std::vector<Arrival> arrivals = drive(4, 60);
  for (std::size_t i = 0; i < 20; ++i)
    arrivals.push_back({arrivals[i].ms + 50, arrivals[i].scan});  // duplicates too
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const Arrival& a, const Arrival& b) { return a.ms < b.ms; });
  std::vector<TrackView> image;
  image.reserve(25);
  const auto strategy = make_strategy(GetParam(), {}, kSchedule);
  std::size_t next = 0;
  const std::int64_t before_all = support::allocations();
  for (std::int64_t now = 0; now <= 5000; now += 10) {
    for (; next < arrivals.size() && arrivals[next].ms <= now; ++next)
      strategy->accept(arrivals[next].scan.view());
    strategy->fuse(at_ms(now));
    if (now % 40 == 0) strategy->image(at_ms(now + 40), image);
  }
  EXPECT_EQ(support::allocations() - before_all, 0);
  EXPECT_EQ(image.size(), 25u);
  // The counter counts.
  const std::int64_t before_one = support::allocations();
  image.reserve(1000);
  EXPECT_EQ(support::allocations() - before_one, 1);
}

}  // namespace
}  // namespace ttf::fusion
