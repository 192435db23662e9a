// Common to all strategies: the result, duplicates, stamps from the future, full waiting rooms, no
// allocation.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "fusion/tracks/timeline.h"
#include "tests/fusion/drives.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::strategies {
namespace {

class EveryStrategy : public testing::TestWithParam<StrategyKind> {};
INSTANTIATE_TEST_SUITE_P(All, EveryStrategy, testing::ValuesIn(kAllStrategies), name_of_strategy);

TEST_P(EveryStrategy, IsKnownByItsName) { EXPECT_EQ(strategy_named(name_of(GetParam())), GetParam()); }

TEST(StrategyNames, AnUnknownOneIsNoStrategy) {
  for (const std::string_view name : {"", "best", "TT", "tt ", "buf"}) EXPECT_EQ(strategy_named(name), std::nullopt);
  EXPECT_EQ(name_of(StrategyKind::kCount), "");
}

TEST_P(EveryStrategy, EndsWithTheBitsOfInOrderProcessing) {
  const std::vector<Arrival> arrivals = drawn_drive(1, 40);
  const auto strategy = make_strategy(GetParam(), {}, laser_and_camera());
  const std::vector<Fused> result = run(*strategy, arrivals, 3500);
  EXPECT_EQ(result.size(), arrivals.size());
  const auto late = std::count_if(result.begin(), result.end(),
                                  [](const Fused& f) { return f.disposition == Disposition::kFusedLate; });
  if (GetParam() == StrategyKind::kAdva)
    EXPECT_GT(late, 5);
  else
    EXPECT_EQ(late, 0) << "all lists came before their instants were settled";

  std::vector<OwnedList> in_order;
  for (const Arrival& a : arrivals) in_order.push_back(a.list);
  std::sort(in_order.begin(), in_order.end(),
            [](const OwnedList& a, const OwnedList& b) { return tracks::before(a.id, a.measured, b.id, b.measured); });
  tracks::Timeline timeline(config::TrackerConfig{}, config::TrackerConfig{}.max_observations);
  for (const OwnedList& s : in_order) timeline.insert(s.view());
  std::vector<tracks::TrackView> expected, image;
  for (const tracks::Track& track : timeline.current().tracks)
    if (track.confirmed) expected.push_back(shown(track, timeline.current().time, at_ms(3300)));
  strategy->image(at_ms(3300), image);
  EXPECT_EQ(image.size(), 25u);
  EXPECT_TRUE(same_bits(image, expected));
  EXPECT_EQ(strategy->confirmed_count(), 25);
  EXPECT_EQ(strategy->newest_measured(), in_order.back().measured);
  ASSERT_EQ(strategy->newest().size(), 2u);
  for (const MeasurementId& id : strategy->newest()) EXPECT_EQ(id.sequence, id.sensor == SensorId{0} ? 39u : 79u);
}

TEST_P(EveryStrategy, AnImageLeavesNoTrace) {
  const auto looked_at = make_strategy(GetParam(), {}, laser_and_camera()),
             undisturbed = make_strategy(GetParam(), {}, laser_and_camera());
  std::vector<Arrival> arrivals = drawn_drive(2, 10);
  sort_by_arrival(arrivals);
  std::size_t next = 0;
  std::vector<tracks::TrackView> image, again, others;
  for (std::int64_t now = 0; now <= 900; now += 10) {
    for (; next < arrivals.size() && arrivals[next].ms <= now; ++next) {
      looked_at->accept(arrivals[next].list.view());
      undisturbed->accept(arrivals[next].list.view());
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

// Half a second later the object is half its speed further, and known less exactly.
TEST_P(EveryStrategy, AnImageIsAPrediction) {
  const auto strategy = make_strategy(GetParam(), {}, std::vector{free_running(0, 60), free_running(1, 30)});
  for (std::uint32_t k = 0; k < 8; ++k) {
    strategy->accept(list_of(1, k, at_ms(40 * k), {position(20.0 + 0.4 * k, 0.0, 0.2)}).view());
    strategy->fuse(at_ms(40 * k + 200));
  }
  std::vector<tracks::TrackView> near, far;
  strategy->image(at_ms(400), near);
  strategy->image(at_ms(900), far);
  ASSERT_EQ(near.size(), 1u);
  ASSERT_EQ(far.size(), 1u);
  EXPECT_NEAR(near[0].state(2), 10.0, 1.0);
  EXPECT_NEAR(far[0].state(0) - near[0].state(0), 0.5 * near[0].state(2), 1e-9);
  EXPECT_GT(far[0].covariance(0, 0), near[0].covariance(0, 0));
}

TEST_P(EveryStrategy, ADuplicateIsReportedAndChangesNothing) {
  const auto once = make_strategy(GetParam(), {}, laser_and_camera()),
             twice = make_strategy(GetParam(), {}, laser_and_camera());
  std::vector<Arrival> arrivals = drawn_drive(3, 6), repeated = arrivals;
  for (const Arrival& a : arrivals) {
    repeated.push_back(a);                     // immediately, while it may still wait
    repeated.push_back({a.ms + 100, a.list});  // long after its fusion
  }
  const std::size_t count = run(*once, arrivals, 1000).size();
  const std::vector<Fused> result = run(*twice, repeated, 1000);
  EXPECT_EQ(result.size(), 3 * count);
  EXPECT_EQ(static_cast<std::size_t>(std::count_if(
                result.begin(), result.end(), [](const Fused& f) { return f.disposition == Disposition::kDuplicate; })),
            2 * count);
  std::vector<tracks::TrackView> a, b;
  once->image(at_ms(1000), a);
  twice->image(at_ms(1000), b);
  EXPECT_FALSE(a.empty());
  EXPECT_TRUE(same_bits(a, b));
}

TEST_P(EveryStrategy, AStampFromTheFutureWaitsForItsTime) {
  const auto strategy = make_strategy(GetParam(), {}, laser_and_camera());
  strategy->accept(list_of(0, 0, at_ms(0), {position(10.0, 0.0, 0.1)}).view());
  strategy->accept(list_of(0, 1, at_ms(30'000), {position(10.0, 0.0, 0.1)}).view());
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
  for (std::uint32_t k = 0; k < many; ++k) strategy->accept(list_of(0, k, at_ms(k)).view());
  strategy->fuse(at_ms(100));
  EXPECT_EQ(strategy->last_fused().size(), many) << "each is accounted for";
  EXPECT_EQ(held(*strategy), GetParam() == StrategyKind::kAdva ? 0u : kMaxPending);
  for (std::size_t i = 0; i < many; ++i) EXPECT_EQ(strategy->last_fused()[i].id.sequence, i);
  strategy->fuse(at_ms(30'000));
  EXPECT_EQ(held(*strategy), 0u);
  EXPECT_EQ(strategy->newest()[0].sequence, many - 1);
}

TEST_P(EveryStrategy, ListsBeyondTheAccountsRoomAreCounted) {
  const auto strategy = make_strategy(GetParam(), {}, laser_and_camera());
  const OwnedList same = list_of(0, 0, at_ms(0));
  strategy->accept(same.view());
  for (std::size_t k = 0; k < kMaxListedArrivals; ++k) strategy->accept(same.view());
  strategy->fuse(at_ms(100));
  EXPECT_EQ(strategy->last_fused().size(), kMaxListedArrivals + 1) << "each is accounted for";
  EXPECT_EQ(strategy->unlisted(), 0u);
  for (std::size_t k = 0; k < kMaxListedArrivals + 3; ++k) strategy->accept(same.view());
  strategy->fuse(at_ms(110));
  EXPECT_GE(strategy->last_fused().size(), kMaxListedArrivals);
  EXPECT_EQ(strategy->unlisted(), 3u);
}

TEST_P(EveryStrategy, AllocatesNothingAfterConstruction) {
  std::vector<Arrival> arrivals = drawn_drive(4, 60);
  for (std::size_t i = 0; i < 20; ++i) arrivals.push_back({arrivals[i].ms + 50, arrivals[i].list});  // duplicates too
  sort_by_arrival(arrivals);
  std::vector<tracks::TrackView> image;
  image.reserve(25);
  const auto strategy = make_strategy(GetParam(), {}, laser_and_camera());
  std::size_t next = 0;
  const std::int64_t before_all = support::allocations();
  for (std::int64_t now = 0; now <= 5000; now += 10) {
    for (; next < arrivals.size() && arrivals[next].ms <= now; ++next) strategy->accept(arrivals[next].list.view());
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
}  // namespace ttf::fusion::strategies
