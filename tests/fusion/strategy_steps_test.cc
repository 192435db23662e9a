// Single fusion instants of each strategy, step by step; whole drives are in strategy_test.cc.
#include "fusion/strategy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

#include "core/random.h"
#include "tests/fusion/scans.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion {
namespace {

using testing::ElementsAre;
using testing_support::at_ms;
using testing_support::position;
using testing_support::scan;

constexpr SensorId kLaser{0}, kCamera{1};

std::vector<SensorTiming> free_sensors() {
  return {{kLaser, Duration::milliseconds(60), false, {}, Duration::milliseconds(80)},
          {kCamera, Duration::milliseconds(30), false, {}, Duration::milliseconds(40)}};
}
std::vector<SensorTiming> scheduled_sensors() {
  return {{kLaser, Duration::milliseconds(60), true, at_ms(0), Duration::milliseconds(80)},
          {kCamera, Duration::milliseconds(30), true, at_ms(0), Duration::milliseconds(40)}};
}

struct Fixture {
  std::unique_ptr<Strategy> strategy;
  Fixture(StrategyKind kind, const std::vector<SensorTiming>& sensors)
      : strategy(make_strategy(kind, {}, sensors)) {}
  void arrives(SensorId sensor, std::uint32_t sequence, std::int64_t measured_ms) {
    const StoredScan s = scan(static_cast<std::uint8_t>(sensor), sequence, measured_ms, {position(20, 0)});
    strategy->accept(s.view());
  }
  // What a fusion instant did, as "laser 0 fused" and the like.
  std::vector<std::string> fuse(std::int64_t now_ms) {
    strategy->fuse(at_ms(now_ms));
    std::vector<std::string> result;
    for (const FusedScan& f : strategy->last_fused()) {
      const char* const words[] = {"", "fused", "late", "held", "too old", "duplicate"};
      result.push_back((f.id.sensor == kLaser ? "laser " : "camera ") + std::to_string(f.id.sequence) + " " +
                       words[static_cast<int>(f.disposition)]);
    }
    return result;
  }
};

//   laser   x(0)--------------------> arrives 50
//   camera        x(20)-----> arrives 40
//   fusion                      45        55
// BUFF: at 45 a laser scan older than 20 may still come (until 80); at 55 it has come: both, in order. The
// laser scan itself need not wait for the camera: a camera scan that is not older has arrived.
TEST(Buff, HoldsUntilTheOtherSensorsOlderScanHasArrived) {
  Fixture f(StrategyKind::kBuff, free_sensors());
  f.arrives(kCamera, 0, 20);
  EXPECT_THAT(f.fuse(45), ElementsAre("camera 0 held"));
  f.arrives(kLaser, 0, 0);
  // The laser's newest is of 0, so one of 1..20 may still come until 20 + 60.
  EXPECT_THAT(f.fuse(55), ElementsAre("laser 0 fused", "camera 0 held"));
  f.arrives(kLaser, 1, 30);
  EXPECT_THAT(f.fuse(58), ElementsAre("camera 0 fused", "laser 1 held"));
}

TEST(Buff, ReleasesWhenNothingOlderCanArriveAnyMore) {
  Fixture f(StrategyKind::kBuff, free_sensors());
  f.arrives(kCamera, 0, 20);
  EXPECT_THAT(f.fuse(79), ElementsAre("camera 0 held"));
  EXPECT_THAT(f.fuse(80), ElementsAre("camera 0 fused"));
}

TEST(Buff, FusesInChronologicalOrder) {
  Fixture f(StrategyKind::kBuff, free_sensors());
  f.arrives(kCamera, 0, 20);
  f.arrives(kCamera, 1, 60);
  f.arrives(kLaser, 0, 40);
  EXPECT_THAT(f.fuse(200), ElementsAre("camera 0 fused", "laser 0 fused", "camera 1 fused"));
}

//   laser   x(0)---------------------> arrives 50
//   camera        x(20)----> arrives 40
// ADVA takes the camera's at once and goes back for the laser's: the tracks then are those of the right
// order.
TEST(Adva, TakesLateScansInExactly) {
  Fixture late(StrategyKind::kAdva, free_sensors()), ordered(StrategyKind::kAdva, free_sensors());
  late.arrives(kCamera, 0, 20);
  EXPECT_THAT(late.fuse(45), ElementsAre("camera 0 fused"));
  late.arrives(kLaser, 0, 0);
  EXPECT_THAT(late.fuse(55), ElementsAre("laser 0 late"));
  ordered.arrives(kLaser, 0, 0);
  ordered.arrives(kCamera, 0, 20);
  EXPECT_THAT(ordered.fuse(55), ElementsAre("laser 0 fused", "camera 0 fused"));
  for (const std::uint32_t k : {1u, 2u, 3u}) {
    late.arrives(kCamera, k, 20 + 40 * k);
    ordered.arrives(kCamera, k, 20 + 40 * k);
  }
  late.fuse(200);
  ordered.fuse(200);
  ASSERT_EQ(late.strategy->tracks().size(), 1u);
  ASSERT_EQ(ordered.strategy->tracks().size(), 1u);
  EXPECT_EQ(late.strategy->tracks()[0].state, ordered.strategy->tracks()[0].state);
  EXPECT_EQ(late.strategy->tracks()[0].covariance, ordered.strategy->tracks()[0].covariance);
}

//   schedule: laser 0, 80, ...  camera 0, 40, 80, ...
//   The camera's scan of 40 arrives at 60, when the laser's of 0 (due at 60) has arrived: fused at once, no
//   waiting for 80.
TEST(TimeTriggered, WaitsOnlyForWhatIsScheduledAndNotYetDue) {
  Fixture f(StrategyKind::kTt, scheduled_sensors());
  f.arrives(kCamera, 0, 0);
  EXPECT_THAT(f.fuse(30), ElementsAre("camera 0 held")) << "the laser's scan of 0 is due at 60";
  f.arrives(kLaser, 0, 0);
  f.arrives(kCamera, 1, 40);
  EXPECT_THAT(f.fuse(60), ElementsAre("laser 0 fused", "camera 0 fused", "camera 1 fused"));
}

TEST(TimeTriggered, FusesAtTheDueInstantOfAMissingScan) {
  Fixture f(StrategyKind::kTt, scheduled_sensors());
  f.arrives(kCamera, 0, 0);
  EXPECT_THAT(f.fuse(59), ElementsAre("camera 0 held"));
  EXPECT_THAT(f.fuse(60), ElementsAre("camera 0 fused"));
}

TEST(AllStrategies, FuseEachScanOnce) {
  for (const auto kind : {StrategyKind::kBuff, StrategyKind::kAdva, StrategyKind::kTt}) {
    Fixture f(kind, free_sensors());
    f.arrives(kCamera, 0, 20);
    f.arrives(kCamera, 0, 20);
    EXPECT_THAT(f.fuse(200), ElementsAre("camera 0 duplicate", "camera 0 fused"));
    f.arrives(kCamera, 0, 20);
    EXPECT_THAT(f.fuse(210), ElementsAre("camera 0 duplicate"));
  }
}

TEST(AllStrategies, AnImageIsAPredictionThatTouchesNothing) {
  for (const auto kind : {StrategyKind::kBuff, StrategyKind::kAdva, StrategyKind::kTt}) {
    Fixture f(kind, free_sensors());
    for (std::uint32_t k = 0; k < 8; ++k) {
      const StoredScan s = scan(1, k, 40 * k, {position(20 + 0.4 * k, 0)});
      f.strategy->accept(s.view());
      f.fuse(40 * k + 200);
    }
    std::vector<TrackView> first, far, again;
    f.strategy->image(at_ms(400), first);
    f.strategy->image(at_ms(900), far);
    f.strategy->image(at_ms(400), again);
    ASSERT_EQ(first.size(), 1u);
    EXPECT_EQ(first[0].state, again[0].state);
    EXPECT_EQ(first[0].covariance, again[0].covariance);
    EXPECT_NEAR(far[0].state(0) - first[0].state(0), 0.5 * first[0].state(2), 1e-9);
    EXPECT_GT(far[0].covariance(0, 0), first[0].covariance(0, 0));
    EXPECT_EQ(f.strategy->newest_measured(), at_ms(280));
    EXPECT_THAT(f.strategy->newest(), ElementsAre(MeasurementId{kCamera, 7}));
  }
}

TEST(AllStrategies, AllocateNothingAfterConstruction) {
  for (const auto kind : {StrategyKind::kBuff, StrategyKind::kAdva, StrategyKind::kTt}) {
    Fixture f(kind, free_sensors());
    RandomStream random({9, 0, Purpose::kTest, 0, 0});
    // Scans are made before counting; every third one is late by two.
    std::vector<StoredScan> scans;
    for (std::uint32_t k = 0; k < 300; ++k) {
      std::vector<Observation> list;
      for (int i = 0; i < 25; ++i)
        list.push_back(
            position(15 + 6 * (i / 5) + 0.2 * random.normal(), 6 * (i % 5 - 2) + 0.2 * random.normal()));
      scans.push_back(
          scan(static_cast<std::uint8_t>(k % 2), k / 2, 40 * k - (k % 3 == 0 ? 90 : 0), std::move(list)));
    }
    std::vector<TrackView> image;
    image.reserve(256);
    const std::int64_t before = support::allocations();
    for (std::uint32_t k = 0; k < 300; ++k) {
      f.strategy->accept(scans[k].view());
      f.strategy->fuse(at_ms(40 * k + 70));
      f.strategy->image(at_ms(40 * k + 80), image);
    }
    EXPECT_EQ(support::allocations() - before, 0);
    EXPECT_EQ(image.size(), 25u);
  }
}

}  // namespace
}  // namespace ttf::fusion
