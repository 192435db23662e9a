// The accuracy of each kind of association and birth. Each keeps the tracker's laws: the same bits in
// every order of arrival, no allocation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <tuple>
#include <vector>

#include "fusion/tracks/timeline.h"
#include "tests/fusion/choices.h"
#include "tests/fusion/crossing.h"
#include "tests/fusion/drives.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::tracks::parts {
namespace {

// Which: the association, the birth, and whether twins are united.
using Options = std::tuple<config::Association, config::Birth, bool>;

std::string name_of_options(const Options& options) {
  return std::string(std::get<0>(options) == config::Association::kNearest ? "Nearest" : "Jpda") +
         (std::get<1>(options) == config::Birth::kMOfN ? "MOfN" : "Existence") + (std::get<2>(options) ? "United" : "");
}

class EveryOption : public testing::TestWithParam<Options> {
 protected:
  config::TrackerConfig config(config::MotionModel motion = config::MotionModel::kConstantVelocity) const {
    config::TrackerConfig config;
    config.motion = motion;
    config.association = std::get<0>(GetParam());
    config.birth = std::get<1>(GetParam());
    config.merge_probability = std::get<2>(GetParam()) ? 0.99 : 0.0;
    config.merge_scans = 2;
    config.clutter_density = 0.005;
    return config;
  }
};
INSTANTIATE_TEST_SUITE_P(All, EveryOption,
                         testing::Combine(testing::Values(config::Association::kNearest, config::Association::kJpda),
                                          testing::Values(config::Birth::kMOfN, config::Birth::kExistence),
                                          testing::Bool()),
                         [](const testing::TestParamInfo<Options>& options) { return name_of_options(options.param); });

// Two objects cross in clutter; sensor 1 sees them a little further on than sensor 0. Gates are shared,
// births are many, and twins appear.
std::vector<OwnedList> crossing_lists(std::uint64_t seed) {
  RandomStream stream({.seed = seed, .purpose = Purpose::kTest, .entity = 9});
  std::vector<OwnedList> lists;
  for (std::uint32_t k = 0; k < 60; ++k) {
    const double t = 0.05 * k, off = k % 2 ? 0.8 : 0.0;
    std::vector<sensors::Observation> list{
        position(20 + 6 * t + off + 0.3 * stream.normal(), -3 + 2 * t + 0.3 * stream.normal(), 0.3),
        position(20 + 6 * t + off + 0.3 * stream.normal(), 3 - 2 * t + 0.3 * stream.normal(), 0.3)};
    while (stream.uniform() < 0.7) list.push_back(position(stream.uniform(10, 50), stream.uniform(-8, 8), 0.3));
    if (stream.uniform() < 0.15) list.erase(list.begin());
    lists.push_back(list_of(static_cast<std::uint8_t>(k % 2), k / 2, at_ms(50 * k), std::move(list)));
  }
  return lists;
}

TEST_P(EveryOption, EveryOrderOfArrivalGivesTheSameBits) {
  for (const config::MotionModel motion :
       {config::MotionModel::kConstantVelocity, config::MotionModel::kCtrv, config::MotionModel::kInteracting}) {
    const std::vector<OwnedList> lists = crossing_lists(3);
    Timeline in_order(config(motion), 32);
    for (const OwnedList& s : lists) in_order.insert(s.view());
    ASSERT_FALSE(in_order.current().tracks.empty());
    RandomStream stream({.seed = 4});
    for (int shuffle = 0; shuffle < 5; ++shuffle) {
      std::vector<std::pair<double, std::size_t>> arrival;
      for (std::size_t k = 0; k < lists.size(); ++k)
        arrival.push_back({static_cast<double>(k) + stream.uniform(0.0, 12.0), k});
      std::sort(arrival.begin(), arrival.end());
      Timeline timeline(config(motion), 32);
      int late = 0;
      for (const auto& [when, k] : arrival) late += timeline.insert(lists[k].view()) == Timeline::Insertion::kLate;
      EXPECT_GT(late, 20);
      ASSERT_TRUE(same_bits(timeline.current(), in_order.current())) << "shuffle " << shuffle;
    }
  }
}

TEST_P(EveryOption, EveryStrategyEndsWithTheBitsOfInOrderProcessing) {
  std::vector<Arrival> arrivals = drawn_drive(7, 20);
  std::vector<OwnedList> in_order;
  for (const Arrival& a : arrivals) in_order.push_back(a.list);
  std::sort(in_order.begin(), in_order.end(),
            [](const OwnedList& a, const OwnedList& b) { return before(a.id, a.measured, b.id, b.measured); });
  Timeline timeline(config(), 64);
  for (const OwnedList& s : in_order) timeline.insert(s.view());
  std::vector<TrackView> expected, image;
  for (const Track& track : timeline.current().tracks)
    if (track.confirmed) expected.push_back(shown(track, timeline.current().time, at_ms(1700)));
  for (const strategies::StrategyKind kind : strategies::kAllStrategies) {
    const auto strategy = make_strategy(kind, config(), laser_and_camera());
    run(*strategy, arrivals, 2000);
    strategy->image(at_ms(1700), image);
    // Names follow the actual order of confirmation.
    for (std::size_t i = 0; i < std::min(image.size(), expected.size()); ++i) image[i].id = expected[i].id;
    EXPECT_TRUE(same_bits(image, expected));
    EXPECT_EQ(image.size(), 25u);
  }
}

TEST_P(EveryOption, AllocatesNothingAfterConstruction) {
  for (const config::MotionModel motion : {config::MotionModel::kConstantVelocity, config::MotionModel::kInteracting}) {
    const std::vector<OwnedList> lists = crossing_lists(5);
    Timeline timeline(config(motion), 32);
    const std::int64_t before_all = support::allocations();
    for (std::size_t k = 0; k + 1 < lists.size(); k += 2) {
      timeline.insert(lists[k + 1].view());
      timeline.insert(lists[k].view());
    }
    EXPECT_EQ(support::allocations() - before_all, 0);
  }
}

// One object, seen for certain, without clutter: JPDA's update is the Kalman update.
TEST(Association, JpdaOfACertainObservationIsTheNearests) {
  for (const config::MotionModel motion :
       {config::MotionModel::kConstantVelocity, config::MotionModel::kCtrv, config::MotionModel::kInteracting}) {
    config::TrackerConfig nearest;
    nearest.motion = motion;
    config::TrackerConfig jpda = nearest;
    jpda.association = config::Association::kJpda;
    jpda.detection_probability = 0.999999;
    jpda.clutter_density = 1e-9;
    Tracker first(nearest, 4), second(jpda, 4);
    TrackSet a(first.max_tracks()), b(second.max_tracks());
    RandomStream stream({.seed = 8});
    for (std::uint32_t k = 0; k < 60; ++k) {
      const double t = 0.05 * k;
      const OwnedList list =
          list_of(0, k, at_ms(50 * k), {position(20.0 + 8.0 * t + 0.2 * stream.normal(), 0.2 * stream.normal(), 0.2)});
      first.step(a, list.view());
      second.step(b, list.view());
      ASSERT_EQ(a.tracks.size(), b.tracks.size()) << k;
      const auto estimator = estimators::make_estimator(nearest);
      for (std::size_t i = 0; i < a.tracks.size(); ++i) {
        ASSERT_EQ(a.tracks[i].hits, b.tracks[i].hits);
        const estimators::Cartesian x = estimator->cartesian(a.tracks[i].estimate),
                                    y = estimator->cartesian(b.tracks[i].estimate);
        ASSERT_LT((x.x - y.x).norm(), 1e-6) << k;
        ASSERT_LT((x.p - y.p).norm(), 1e-6 * x.p.norm()) << k;
      }
    }
  }
}

// Between two equally likely observations, the mean stays between them and the covariance grows.
TEST(Association, JpdaLeavesAnAmbiguityOpen) {
  config::TrackerConfig config;
  config.association = config::Association::kJpda;
  config.clutter_density = 0.01;
  Tracker tracker(config, 4);
  TrackSet set(tracker.max_tracks());
  for (std::uint32_t k = 0; k < 10; ++k)
    tracker.step(set, list_of(0, k, at_ms(50 * k), {position(20.0, 0.0, 0.3)}).view());
  ASSERT_EQ(set.tracks.size(), 1u);
  const double before = seen_as(set.tracks[0].estimate).p(1, 1);
  const estimators::State x = state_of(set.tracks[0]);
  tracker.step(set,
               list_of(0, 10, at_ms(500), {position(x(0), x(1) + 0.6, 0.3), position(x(0), x(1) - 0.6, 0.3)}).view());
  const estimators::Cartesian after = seen_as(set.tracks[0].estimate);
  EXPECT_NEAR(after.x(1), x(1), 0.02);
  EXPECT_GT(after.p(1, 1), before) << "the spread of the innovations";
}

TEST(Association, ACrowdIsApproximatedAndSaysSo) {
  config::TrackerConfig config;
  config.association = config::Association::kJpda;
  config.initial_velocity_sigma = 100.0;
  Tracker tracker(config, 32);
  TrackSet set(tracker.max_tracks());
  RandomStream stream({.seed = 9});
  for (std::uint32_t k = 0; k < 3; ++k) {
    std::vector<sensors::Observation> list;
    for (int i = 0; i < 25; ++i) list.push_back(position(20.0 + stream.normal(), stream.normal(), 0.2));
    tracker.step(set, list_of(0, k, at_ms(50 * k), list).view());
  }
  EXPECT_GT(tracker.approximated_clusters(), 0u);
  for (const Track& track : set.tracks) EXPECT_TRUE(state_of(track).allFinite());
}

Followed follow_by(config::Association association, config::Birth birth, double clutter_density, int runs) {
  Crossing crossing;
  crossing.clutter_density = clutter_density;
  config::TrackerConfig config = crossing.config();
  config.association = association;
  config.birth = birth;
  const Followed followed = follow(crossing, config, runs);
  std::cout << (association == config::Association::kNearest ? "nearest" : "jpda")
            << (birth == config::Birth::kMOfN ? ", m_of_n" : ", existence") << " at " << clutter_density
            << " per m^2: NEES " << followed.nees << " of 4, GOSPA " << followed.gospa << " m, " << followed.switches
            << " switches, " << followed.misses << " misses, " << followed.false_tracks << " false\n";
  return followed;
}

// A list has 36 false observations. Deciding makes a track overconfident; weighing keeps it consistent. The
// band is that of 300 runs of one independent judgement each, twice as wide: 4 +- 2 x 1.96 sqrt(8 / 300).
TEST(Association, CrossingInClutterIsConsistentWithJpdaOnly) {
  const Followed nearest = follow_by(config::Association::kNearest, config::Birth::kExistence, 0.03, 300);
  const Followed jpda = follow_by(config::Association::kJpda, config::Birth::kExistence, 0.03, 300);
  EXPECT_GT(jpda.nees, 3.4);
  EXPECT_LT(jpda.nees, 4.6);
  EXPECT_GT(nearest.nees, 4.7);
  EXPECT_LT(jpda.gospa, nearest.gospa);
  EXPECT_LT(jpda.gospa, 0.5);
  EXPECT_LT(jpda.false_tracks, nearest.false_tracks);
  // Both objects are born among the false observations. From 1.5 s on each is there 45 times in a drive.
  constexpr std::uint64_t kThere = 300 * 2 * 45;
  EXPECT_LT(jpda.misses, kThere / 50);
  EXPECT_LT(nearest.misses, kThere / 40);
  EXPECT_LT(jpda.false_tracks, kThere / 500);
  // Two that came close are taken for each other now and then, by either.
  EXPECT_LT(jpda.switches, 30u);
  EXPECT_LT(nearest.switches, 30u);
}

// M of N counts observations, and clutter has enough of them. Existence says how many to expect.
TEST(Association, CrossingInClutterExistenceBelievesLittleOfIt) {
  for (const config::Association association : {config::Association::kNearest, config::Association::kJpda}) {
    const Followed counted = follow_by(association, config::Birth::kMOfN, 0.01, 20);
    const Followed believed = follow_by(association, config::Birth::kExistence, 0.01, 20);
    EXPECT_LT(100 * believed.false_tracks, counted.false_tracks);
    EXPECT_LT(believed.gospa, 0.1 * counted.gospa);
  }
}

TEST(Association, AConfirmedTrackKeepsItsObservationFromATentativeOne) {
  // The tentative track lies nearer, but the confirmed track gets an observation that both want.
  Bench bench;
  for (int k = 0; k < 6; ++k) bench.step(50 * k, {position(20.0, 0.0, 0.3)});
  bench.step(300, {position(20.0, 0.0, 0.3), position(22.0, 0.0, 0.3)});
  ASSERT_EQ(bench.set.tracks.size(), 2u);
  bench.step(350, {position(20.8, 0.0, 0.3)});
  EXPECT_EQ(bench.set.tracks[0].misses, 0);
  EXPECT_EQ(bench.set.tracks[1].misses, 1);
}

}  // namespace
}  // namespace ttf::fusion::tracks::parts
