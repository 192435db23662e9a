// Tracks that take late lists in by a method, against rewound tracks.
#include "fusion/strategies/late/late_updates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "fusion/metrics/consistency.h"
#include "tests/fusion/strategies/late/late_scenes.h"

namespace ttf::fusion::strategies::late {
namespace {

using oosm::Kind;
using Insertion = tracks::TrackHistory::Insertion;

constexpr std::size_t kRoom = 16;
constexpr std::size_t kInTime = 8;

class EveryMethod : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(LateUpdates, EveryMethod,
                         testing::Values(Kind::kAugmented, Kind::kClone, Kind::kAdjoint, Kind::kAl1, Kind::kBl1,
                                         Kind::kA, Kind::kB, Kind::kC),
                         name_of_kind);

// Law L1 of fusion/oosm/method.h for tracks: without late lists, the bits stay the same.
TEST_P(EveryMethod, GivesTheBitsOfTheTrackerInOrder) {
  for (const config::MotionModel motion :
       {config::MotionModel::kConstantVelocity, config::MotionModel::kConstantAcceleration}) {
    const config::TrackerConfig config = taking_late(GetParam(), motion);
    LateUpdates late(config, kRoom, in_turn());
    tracks::Timeline rewinding(config, kRoom);
    for (const OwnedList& list : few_objects(3, 80, 0)) {
      ASSERT_EQ(late.insert(list.view()), Insertion::kInOrder);
      rewinding.insert(list.view());
      ASSERT_TRUE(same_bits(late.current(), rewinding.current()));
    }
    ASSERT_GE(late.current().tracks.size(), 4u);
    for (std::size_t t = 0; t < late.current().tracks.size(); ++t)
      EXPECT_EQ(late.current().tracks[t].id, rewinding.current().tracks[t].id);
  }
}

// Lists in time are taken in as before, regardless of late ones.
struct Compared {
  int late = 0, too_old = 0;
  double worst = 0.0;  // relative difference of estimates
  bool counted_alike = true;
};
Compared compare(const config::TrackerConfig& config, const std::vector<OwnedList>& lists,
                 const std::vector<std::size_t>& order) {
  Compared result;
  LateUpdates late(config, kRoom, in_turn());
  tracks::Timeline rewinding(config, kRoom);
  for (const std::size_t i : order) {
    const Insertion insertion = late.insert(lists[i].view());
    if (insertion == Insertion::kTooOld) {
      ++result.too_old;
      continue;
    }
    result.late += insertion == Insertion::kLate ? 1 : 0;
    rewinding.insert(lists[i].view());
    const std::vector<tracks::Track>&one = late.current().tracks, &other = rewinding.current().tracks;
    if (one.size() != other.size()) return {.counted_alike = false};
    for (std::size_t t = 0; t < one.size(); ++t) {
      result.worst = std::max(result.worst, relative_difference(one[t].estimate, other[t].estimate));
      result.counted_alike = result.counted_alike && one[t].birth == other[t].birth &&
                             one[t].newest == other[t].newest && one[t].hits == other[t].hits &&
                             one[t].misses == other[t].misses && one[t].lists == other[t].lists &&
                             one[t].confirmed == other[t].confirmed && one[t].id == other[t].id;
    }
  }
  return result;
}

constexpr double kExact = 1e-9;

//      0 1 2 3 4 5 6 7 | each behind up to six others, also of the same track
class ExactInAnyOrder : public testing::TestWithParam<std::tuple<Kind, config::MotionModel>> {};
INSTANTIATE_TEST_SUITE_P(LateUpdates, ExactInAnyOrder,
                         testing::Combine(testing::Values(Kind::kAugmented, Kind::kClone),
                                          testing::Values(config::MotionModel::kConstantVelocity,
                                                          config::MotionModel::kConstantAcceleration)));
TEST_P(ExactInAnyOrder, TracksAreThoseOfOrder) {
  const auto [kind, motion] = GetParam();
  int late = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream stream({.seed = seed});
    const Compared result =
        compare(taking_late(kind, motion), few_objects(seed, 70), drawn_order(stream, 70, kInTime, 6));
    EXPECT_LT(result.worst, kExact) << "seed " << seed;
    EXPECT_TRUE(result.counted_alike) << "seed " << seed;
    EXPECT_EQ(result.too_old, 0) << "seed " << seed;
    late += result.late;
  }
  EXPECT_GT(late, 400);
}

//      0 .. 7 | 9 10 11 8 | 13 14 15 12 | ...
class ExactWithOneLate : public testing::TestWithParam<std::tuple<Kind, std::size_t>> {};
INSTANTIATE_TEST_SUITE_P(AtAnyLag, ExactWithOneLate,
                         testing::Combine(testing::Values(Kind::kAdjoint, Kind::kAugmented, Kind::kClone),
                                          testing::Values(1u, 2u, 3u, 6u)));
INSTANTIATE_TEST_SUITE_P(AtOneLag, ExactWithOneLate,
                         testing::Combine(testing::Values(Kind::kA, Kind::kAl1), testing::Values(1u)));
TEST_P(ExactWithOneLate, TracksAreThoseOfOrder) {
  const auto [kind, lag] = GetParam();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Compared result = compare(taking_late(kind), few_objects(seed, 64), one_late_order(64, kInTime, lag));
    EXPECT_LT(result.worst, kExact) << "seed " << seed;
    EXPECT_TRUE(result.counted_alike) << "seed " << seed;
    EXPECT_EQ(result.too_old, 0) << "seed " << seed;
    EXPECT_GE(result.late, 8);
  }
}

// Every other list is of a sensor that looks back and sees no object. Late or not, it counts for no track.
TEST_P(EveryMethod, AListOfABlindSensorCountsForNoTrack) {
  config::TrackerConfig config = taking_late(GetParam());
  config.sensors.resize(2);
  config.sensors[1].mounting.yaw = kPi;
  config.sensors[1].field = {.half_angle = 0.5};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    std::vector<OwnedList> lists = few_objects(seed, 64);
    for (OwnedList& list : lists)
      if (list.id.sensor == SensorId{1}) list.observations.clear();
    const Compared result = compare(config, lists, one_late_order(64, 2 * kInTime, 2));
    EXPECT_GT(result.late, 10) << "seed " << seed;
    EXPECT_TRUE(result.counted_alike) << "seed " << seed;
    LateUpdates late(config, kRoom, in_turn());
    for (const OwnedList& list : lists) late.insert(list.view());
    EXPECT_EQ(late.current().tracks.size(), 4u) << "seed " << seed;
    for (const tracks::Track& track : late.current().tracks) EXPECT_LE(track.lists, 32) << "seed " << seed;
  }
}

// B, C and Bl1 are exact without process noise. The tracker always has some, so this uses the least.
class ExactWithoutNoise : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(LateUpdates, ExactWithoutNoise, testing::Values(Kind::kB, Kind::kC, Kind::kBl1), name_of_kind);
TEST_P(ExactWithoutNoise, TracksAreThoseOfOrder) {
  config::TrackerConfig config = taking_late(GetParam());
  config.process_noise = 1e-9;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Compared result = compare(config, few_objects(seed, 64), one_late_order(64, kInTime, 1));
    EXPECT_LT(result.worst, 1e-6) << "seed " << seed;
    EXPECT_TRUE(result.counted_alike) << "seed " << seed;
    EXPECT_GT(result.late, 20);
  }
}

// An object drives as the model says, seen by two sensors in turn. The lists come in an order that suits the
// method. The error at each drive's end is judged by its own covariance (the drives are independent).
metrics::Consistency drives(Kind kind, int runs) {
  metrics::Consistency nees;
  const config::TrackerConfig config = taking_late(kind);
  const std::vector<std::size_t> one_late = one_late_order(30, 4, kind == Kind::kA || kind == Kind::kAl1 ? 1 : 3);
  for (int run = 0; run < runs; ++run) {
    RandomStream stream({.seed = 11, .replication = static_cast<std::uint32_t>(run)});
    estimators::State truth = estimators::State::Zero();
    truth(0) = 100.0;
    truth(2) = config.initial_velocity_sigma * stream.normal();
    truth(3) = config.initial_velocity_sigma * stream.normal();
    std::vector<OwnedList> lists;
    for (std::uint32_t k = 0; k < 30; ++k) {
      if (k > 0)
        truth = draw(transition(config.motion, 0.02) * truth, driving_noise(config.motion, config.process_noise, 0.02),
                     stream);
      lists.push_back(list_of(static_cast<std::uint8_t>(k % 2), k / 2, at_ms(20 * k),
                              {position(truth(0) + 0.3 * stream.normal(), truth(1) + 0.3 * stream.normal(), 0.3)}));
    }
    const bool any_order = kind == Kind::kAugmented || kind == Kind::kClone;
    LateUpdates late(config, 4, in_turn());
    for (const std::size_t i : any_order ? drawn_order(stream, 30, 4, 6) : one_late)
      EXPECT_NE(late.insert(lists[i].view()), Insertion::kTooOld);
    EXPECT_EQ(late.current().tracks.size(), 1u);
    EXPECT_EQ(late.current().tracks[0].lists, 30);
    const estimators::Cartesian end = seen_as(late.current().tracks[0].estimate);
    nees.add(metrics::nees<4>({end.x.head<4>(), end.p.topLeftCorner<4, 4>()}, truth.head<4>()), 4);
  }
  return nees;
}

class ExactMethod : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(LateUpdates, ExactMethod,
                         testing::Values(Kind::kAugmented, Kind::kClone, Kind::kAdjoint, Kind::kA, Kind::kAl1),
                         name_of_kind);
TEST_P(ExactMethod, IsConsistentOverThreeHundredDrives) {
  const metrics::Consistency nees = drives(GetParam(), 300);
  EXPECT_EQ(nees.degrees(), 1200u);
  EXPECT_TRUE(nees.consistent()) << nees.mean() << " in " << nees.band().low << " .. " << nees.band().high;
}

// Al1 and Bl1 at three lags are "a few percent" worse, B hardly at all. This compares the standard deviations
// of position and velocity in the middle of so many drives.
class ApproximateMethod : public testing::TestWithParam<std::tuple<Kind, std::size_t>> {};
INSTANTIATE_TEST_SUITE_P(LateUpdates, ApproximateMethod,
                         testing::Values(std::tuple(Kind::kAl1, 3u), std::tuple(Kind::kBl1, 3u),
                                         std::tuple(Kind::kBl1, 1u), std::tuple(Kind::kB, 1u)));
TEST_P(ApproximateMethod, IsAFewPercentOff) {
  const auto [kind, lag] = GetParam();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::vector<OwnedList> lists = few_objects(seed, 64);
    const config::TrackerConfig config = taking_late(kind);
    LateUpdates late(config, kRoom, in_turn());
    tracks::Timeline rewinding(config, kRoom);
    for (const std::size_t i : one_late_order(64, kInTime, lag)) {
      ASSERT_NE(late.insert(lists[i].view()), Insertion::kTooOld);
      rewinding.insert(lists[i].view());
      ASSERT_EQ(late.current().tracks.size(), rewinding.current().tracks.size());
      for (std::size_t t = 0; t < late.current().tracks.size(); ++t) {
        const estimators::Cartesian one = seen_as(late.current().tracks[t].estimate),
                                    other = seen_as(rewinding.current().tracks[t].estimate);
        for (int c = 0; c < 4; ++c) {
          EXPECT_NEAR(std::sqrt(one.p(c, c) / other.p(c, c)), 1.0, 0.05) << "component " << c;
          EXPECT_NEAR(one.x(c), other.x(c), 0.2 * std::sqrt(other.p(c, c))) << "component " << c;
        }
      }
    }
  }
}

}  // namespace
}  // namespace ttf::fusion::strategies::late
