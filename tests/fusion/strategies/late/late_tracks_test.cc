// A late list's effects on tracks beside their state, and the lists that are not taken in.
#include <gtest/gtest.h>

#include <optional>

#include "fusion/strategies/late/late_updates.h"
#include "tests/fusion/strategies/late/late_scenes.h"

namespace ttf::fusion::strategies::late {
namespace {

using oosm::Kind;
using Insertion = tracks::TrackHistory::Insertion;

class LateList : public testing::Test {
 protected:
  static OwnedList at(std::uint8_t sensor, std::uint32_t sequence, std::int64_t ms,
                      std::vector<sensors::Observation> seen) {
    return list_of(sensor, sequence, at_ms(ms), std::move(seen));
  }
  // Drives at 20 m/s.
  static sensors::Observation car(std::int64_t ms, double sigma = 0.1) {
    return position(10.0 + 0.02 * static_cast<double>(ms), 0.0, sigma);
  }
  // Lists of sensor 0, every 40 ms.
  static void drive(LateUpdates& late, std::uint32_t lists) {
    for (std::uint32_t k = 0; k < lists; ++k)
      ASSERT_EQ(late.insert(at(0, k, 40 * k, {car(40 * k)}).view()), Insertion::kInOrder);
  }
};

// At the track's present place, 4 m further on, it would be far outside.
TEST_F(LateList, BelongsToWhereTheTrackWas) {
  LateUpdates late(taking_late(Kind::kAugmented), 4, in_turn());
  drive(late, 12);
  EXPECT_EQ(late.insert(at(1, 0, 240, {car(240)}).view()), Insertion::kLate);
  ASSERT_EQ(late.current().tracks.size(), 1u);
  EXPECT_EQ(late.current().tracks[0].lists, 13);
  EXPECT_EQ(late.current().tracks[0].hits, 0x1fffu);
}

TEST_F(LateList, GivesBirthToNothing) {
  LateUpdates late(taking_late(Kind::kAugmented), 4, in_turn());
  drive(late, 6);
  EXPECT_EQ(late.insert(at(1, 0, 140, {position(80.0, 9.0, 0.1), car(140)}).view()), Insertion::kLate);
  ASSERT_EQ(late.current().tracks.size(), 1u);
  EXPECT_EQ(late.current().tracks[0].hits, 0x7fu);
}

// The scene of Timeline.ALateListReopensAssociations: here the two stay two.
//
//   x [m]                             o 18.5
//                    o 7.5 (late)
//        o 0
//       0 s         1 s              2 s
TEST_F(LateList, ReopensNoAssociation) {
  config::TrackerConfig config;
  config.late = Kind::kAugmented;
  config.initial_velocity_sigma = 2.0;
  config.process_noise = 4.0;
  config.delete_position_sigma = 50.0;
  config.delete_after = Duration::milliseconds(2'000);
  LateUpdates late(config, 4, {});
  late.insert(at(0, 0, 0, {position(0.0, 0.0, 0.1)}).view());
  late.insert(at(0, 1, 2000, {position(18.5, 0.0, 0.1)}).view());
  EXPECT_EQ(late.insert(at(1, 0, 1000, {position(7.5, 0.0, 0.1)}).view()), Insertion::kLate);
  ASSERT_EQ(late.current().tracks.size(), 2u);
  EXPECT_EQ(late.current().tracks[0].hits, 0b110u) << "it was missed, then seen late, then missed";
  EXPECT_EQ(late.current().tracks[0].newest.measured, at_ms(1000));
  EXPECT_EQ(late.current().tracks[0].misses, 1);
  EXPECT_EQ(late.current().tracks[1].hits, 0b1u) << "it was born later";
  EXPECT_EQ(late.current().tracks[1].lists, 1);
}

//   o     o     .    (o)    .          o seen, . missed, ( ) late
//   0    40    80    100   120 ms
TEST_F(LateList, CountsAtItsPlace) {
  for (const bool seen : {true, false}) {
    LateUpdates late(taking_late(Kind::kAugmented), 4, in_turn());
    drive(late, 2);
    late.insert(at(0, 2, 80, {}).view());
    late.insert(at(0, 3, 120, {}).view());
    ASSERT_EQ(late.current().tracks.size(), 1u);
    EXPECT_EQ(late.current().tracks[0].misses, 2);
    EXPECT_FALSE(late.current().tracks[0].confirmed);
    const OwnedList list = seen ? at(1, 0, 100, {car(100)}) : at(1, 0, 100, {});
    ASSERT_EQ(late.insert(list.view()), Insertion::kLate);
    if (!seen) {
      EXPECT_TRUE(late.current().tracks.empty()) << "three hits in five lists are out of reach";
      continue;
    }
    const tracks::Track& track = late.current().tracks[0];
    EXPECT_EQ(track.hits, 0b11010u);
    EXPECT_EQ(track.misses, 1);
    EXPECT_EQ(track.lists, 5);
    EXPECT_EQ(track.newest, (tracks::ObservationId{{SensorId{1}, 0}, 0, at_ms(100)}));
    EXPECT_TRUE(track.confirmed) << "three of five";
    EXPECT_NE(track.id, kNoTrack);
  }
}

// A confirmed track ends where a late list is the miss that was missing.
TEST_F(LateList, CanEndATrack) {
  config::TrackerConfig config = taking_late(Kind::kAl1);
  config.delete_misses = 3;
  LateUpdates late(config, 4, {});
  drive(late, 5);
  late.insert(at(0, 5, 200, {}).view());
  late.insert(at(0, 6, 240, {}).view());
  ASSERT_EQ(late.current().tracks.size(), 1u);
  EXPECT_EQ(late.insert(at(1, 0, 220, {}).view()), Insertion::kLate);
  EXPECT_TRUE(late.current().tracks.empty());
  // Its place is another's: a new track begins where the first did.
  for (std::uint32_t k = 7; k < 12; ++k) late.insert(at(0, k, 40 * k, {car(40 * k)}).view());
  ASSERT_EQ(late.current().tracks.size(), 1u);
  EXPECT_EQ(late.current().tracks[0].lists, 5);
  EXPECT_EQ(late.insert(at(1, 1, 370, {car(370)}).view()), Insertion::kLate);
  EXPECT_EQ(late.insert(at(1, 2, 270, {car(270)}).view()), Insertion::kTooOld) << "the first's past is forgotten";
}

// Without a random walk, a measured axis or side counts the same at any age.
TEST_F(LateList, TurnsAndSizesAsOneOfNow) {
  config::TrackerConfig config = taking_late(Kind::kAugmented);
  config.heading_noise = config.initial_turn_rate_sigma = config.extent_noise = 0.0;
  const auto measured = [](sensors::Observation z, double heading, double length) {
    z.has_heading = z.has_length = true;
    z.heading = heading;
    z.length = length;
    z.sigma_heading = 0.05;
    z.sigma_length = 0.3;
    return z;
  };
  tracks::Track walking, standing, in_order;
  for (const bool walks : {false, true}) {
    if (walks) config.heading_noise = config.extent_noise = 1.0;
    LateUpdates late(config, 4, {});
    tracks::Timeline rewinding(config, 4);
    for (std::uint32_t k = 0; k < 6; ++k) {
      const OwnedList list = at(0, k, 40 * k, {measured(car(40 * k), 0.03 * k, 4.0 + 0.1 * k)});
      late.insert(list.view());
      rewinding.insert(list.view());
    }
    const OwnedList list = at(1, 0, 60, {measured(car(60), 0.1, 4.9)});
    late.insert(list.view());
    rewinding.insert(list.view());
    (walks ? walking : standing) = late.current().tracks[0];
    if (!walks) in_order = rewinding.current().tracks[0];
  }
  EXPECT_NEAR(standing.heading.value, in_order.heading.value, 1e-12);
  EXPECT_NEAR(standing.heading.variance, in_order.heading.variance, 1e-12);
  EXPECT_NEAR(standing.extent.covariance(0, 0), in_order.extent.covariance(0, 0), 1e-12);
  EXPECT_NEAR(standing.extent.size(0), in_order.extent.size(0), 0.1) << "what repeats counts the less, the later";
  EXPECT_GT(walking.heading.variance, standing.heading.variance);
}

//   z: 1.0      2.0 (late)   -       3.0    0.5 (late)      what is shown: 1, 2, 2, 3, 3
//      0 ms      20         40       80     60
TEST_F(LateList, CarriesTheNewestHeightAndEveryScore) {
  const auto with = [](sensors::Observation z, std::optional<double> height, std::uint8_t what) {
    z.third.has_z = height.has_value();
    z.third.z = height.value_or(0.0);
    z.class_id = sensors::ClassId{what};
    z.score = 1.0;
    return z;
  };
  LateUpdates late(taking_late(Kind::kAugmented), 4, {});
  const auto shown = [&] { return late.current().tracks[0].unfiltered; };
  late.insert(at(0, 0, 0, {with(car(0), 1.0, 0)}).view());
  late.insert(at(0, 1, 40, {with(car(40), std::nullopt, 1)}).view());
  EXPECT_EQ(shown().third.z, 1.0);
  ASSERT_EQ(late.insert(at(1, 0, 20, {with(car(20), 2.0, 1)}).view()), Insertion::kLate);
  EXPECT_EQ(shown().third.z, 2.0);
  late.insert(at(0, 2, 80, {with(car(80), 3.0, 1)}).view());
  ASSERT_EQ(late.insert(at(1, 1, 60, {with(car(60), 0.5, 0)}).view()), Insertion::kLate);
  EXPECT_EQ(shown().third.z, 3.0);
  EXPECT_EQ(shown().classes.sums[0], 2.0);
  EXPECT_EQ(shown().classes.sums[1], 3.0);
}

// Twenty lists. A track remembers the last fifteen before the newest, and clones the announced ones.
TEST_F(LateList, IsTooOldWhereNoTrackReaches) {
  LateUpdates late(taking_late(Kind::kAugmented), 4, {});
  EXPECT_EQ(late.insert(at(0, 100, 1, {}).view()), Insertion::kInOrder);
  EXPECT_EQ(late.insert(at(1, 100, 0, {car(0)}).view()), Insertion::kTooOld) << "there is no track";
  LateUpdates other(taking_late(Kind::kAugmented), 4, {});
  drive(other, 20);
  const tracks::TrackSet before_too_old = other.current();
  EXPECT_EQ(other.insert(at(1, 0, 40 * 4 - 1, {car(159)}).view()), Insertion::kTooOld);
  EXPECT_TRUE(same_bits(other.current(), before_too_old));
  EXPECT_FALSE(other.contains({SensorId{1}, 0}, at_ms(159)));
  EXPECT_EQ(other.insert(at(1, 0, 40 * 4 + 1, {car(161)}).view()), Insertion::kLate);
  EXPECT_TRUE(other.contains({SensorId{1}, 0}, at_ms(161)));
  EXPECT_FALSE(same_bits(other.current(), before_too_old));
}

TEST_F(LateList, IsTooOldBeforeTheHistoryOfLists) {
  config::TrackerConfig config = taking_late(Kind::kAugmented);
  config.history_scans = 4;
  LateUpdates late(config, 4, {});
  drive(late, 10);
  EXPECT_EQ(late.insert(at(1, 0, 199, {car(199)}).view()), Insertion::kTooOld);
  EXPECT_EQ(late.insert(at(1, 1, 201, {car(201)}).view()), Insertion::kLate);
}

// A, B and C go one measurement back, of each track.
TEST_F(LateList, IsTooOldBehindOneLag) {
  LateUpdates late(taking_late(Kind::kA), 4, {});
  drive(late, 6);
  EXPECT_EQ(late.insert(at(1, 0, 159, {car(159)}).view()), Insertion::kTooOld);
  EXPECT_EQ(late.insert(at(1, 1, 161, {car(161)}).view()), Insertion::kLate);
  late.insert(at(0, 6, 240, {}).view());
  EXPECT_EQ(late.insert(at(1, 2, 190, {car(190)}).view()), Insertion::kLate) << "the last list was a miss";
}

// The clocks of sensor 1 are off by up to 60 us. The list that fits no instant was never announced.
TEST_F(LateList, OfACloneMustFitTheSchedule) {
  const config::TrackerConfig config = taking_late(Kind::kClone);
  LateUpdates late(config, 4, in_turn());
  tracks::Timeline rewinding(config, 4);
  const auto both = [&](const OwnedList& list) {
    rewinding.insert(list.view());
    return late.insert(list.view());
  };
  std::uint32_t came_late = 0;
  for (std::uint32_t k = 0; k < 40; ++k) {
    both(at(0, k, 40 * k, {car(40 * k)}));
    if (k < 3) continue;
    OwnedList list = at(1, k, 40 * (k - 1) - 20, {car(40 * (k - 1) - 20)});
    list.measured += Duration::microseconds(static_cast<std::int64_t>(k % 7) * 20 - 60);
    came_late += both(list) == Insertion::kLate ? 1u : 0u;
    ASSERT_EQ(late.current().tracks.size(), 1u);
    ASSERT_LT(relative_difference(late.current().tracks[0].estimate, rewinding.current().tracks[0].estimate), 1e-7);
  }
  EXPECT_EQ(came_late, 37u);
  EXPECT_EQ(late.insert(at(1, 100, 1551, {car(1551)}).view()), Insertion::kTooOld) << "11 ms off";
  EXPECT_EQ(late.insert(at(1, 101, 1500, {car(1500)}).view()), Insertion::kTooOld) << "its clone has served";
  EXPECT_EQ(late.insert(at(2, 0, 1540, {car(1540)}).view()), Insertion::kTooOld) << "a sensor without a schedule";
  EXPECT_EQ(late.insert(at(1, 102, 1540, {car(1540)}).view()), Insertion::kLate);
}

}  // namespace
}  // namespace ttf::fusion::strategies::late
