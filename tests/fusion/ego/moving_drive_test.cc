// Whole drives of a vehicle that turns at 30 km/h: standing objects, lists late and out of order, odometry with noise, bias and
// scale error.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "fusion/metrics/consistency.h"
#include "fusion/sensors/among_biases.h"
#include "fusion/sensors/position.h"
#include "fusion/sensors/range_bearing_rate.h"
#include "fusion/tracks/own_axes.h"
#include "fusion/tracks/timeline.h"
#include "tests/fusion/drives.h"
#include "tests/fusion/ego/vehicle.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::ego {
namespace {

using strategies::StrategyKind;

const std::vector<linear::Vector<2>>& standing_objects() {
  static const std::vector<linear::Vector<2>> kObjects{{36.0, 16.0}, {45.0, 30.0}, {30.0, -8.0}, {15.0, 40.0}};
  return kObjects;
}

// A list that came at an instant, in the sensor's axes.
struct Unplaced {
  std::int64_t ms = 0;
  MeasurementId id;
  std::int64_t measured_ms = 0;
  std::vector<sensors::Observation> observations;
};

struct Moving {
  config::TrackerConfig config;
  std::vector<OdometrySample> samples;  // each comes after 2 ms
  std::vector<Unplaced> lists;          // by arrival
};

// Errors that matter: a bias of 0.01 rad/s moves an object at 30 m with 0.3 m/s.
config::TrackerConfig config_of_moving() {
  config::TrackerConfig config;
  config.process_noise = 0.05;
  config.sensors.resize(2);
  config.sensors[0].mounting = {.position = {3.5, 0.0}};
  config.sensors[1].mounting = {.position = {1.8, 0.3}, .yaw = 0.1};
  config.odometry.emplace();
  config.odometry->yaw_rate_bias_sigma = 0.01;
  config.odometry->speed_scale_sigma = 0.02;
  return config;
}

// The laser and the camera of laser_and_camera(). A delay is at least `least_ms`.
Moving drawn_moving(std::uint32_t replication, std::int64_t until_ms, std::int64_t least_ms) {
  static const Vehicle kVehicle(6.0);
  RandomStream draw({.seed = 11, .replication = replication});
  Moving drive{.config = config_of_moving(), .samples = {}, .lists = {}};
  drive.samples = drawn_samples(*drive.config.odometry, until_ms, draw);
  for (const int s : {0, 1}) {
    const std::int64_t first = s == 0 ? 80 : 60, period = s == 0 ? 80 : 40, worst = s == 0 ? 60 : 35;
    const sensors::Mounting& mounting = drive.config.sensors[static_cast<std::size_t>(s)].mounting;
    std::uint32_t sequence = 0;
    for (std::int64_t ms = first; ms < until_ms; ms += period) {
      Unplaced list{
          .ms = ms + least_ms + static_cast<std::int64_t>(draw.uniform() * static_cast<double>(worst - least_ms)),
          .id = {static_cast<SensorId>(s), sequence++},
          .measured_ms = ms,
          .observations = {}};
      for (const linear::Vector<2>& object : standing_objects()) {
        const linear::Vector<2> seen =
            sensors::turned(kVehicle.seen(object, seconds_of(ms)) - mounting.position, -mounting.yaw);
        list.observations.push_back(position(seen.x() + 0.2 * draw.normal(), seen.y() + 0.2 * draw.normal(), 0.2));
      }
      drive.lists.push_back(list);
    }
  }
  std::stable_sort(drive.lists.begin(), drive.lists.end(), [](const auto& a, const auto& b) { return a.ms < b.ms; });
  return drive;
}

void place_all(Unplaced& list, const std::vector<sensors::KnownSensor>& sensors, const EgoState& ego) {
  for (sensors::Observation& z : list.observations) {
    place(z, list.id.sensor, sensors[index_of(list.id.sensor)]);
    carry(z, ego);
  }
}

// Runs a drive as the fusion node does. Calls image(now, path) at each fusion instant, every 10 ms.
template <class Image>
void run_moving(strategies::Strategy& strategy, const Moving& drive, std::int64_t until_ms, Image image) {
  EgoPath path(*drive.config.odometry);
  std::size_t next_sample = 0, next_list = 0;
  for (std::int64_t now = 0; now <= until_ms; now += 10) {
    for (;
         next_sample < drive.samples.size() && drive.samples[next_sample].at + Duration::milliseconds(2) <= at_ms(now);
         ++next_sample)
      path.accept(drive.samples[next_sample]);
    for (; next_list < drive.lists.size() && drive.lists[next_list].ms <= now; ++next_list) {
      Unplaced list = drive.lists[next_list];
      const EgoState ego = path.at(at_ms(list.measured_ms)).value();
      place_all(list, drive.config.sensors, ego);
      strategy.accept({list.id, at_ms(list.measured_ms), list.observations, ego.vehicle});
    }
    strategy.fuse(at_ms(now));
    image(now, path);
  }
}

class MovingDrive : public testing::TestWithParam<StrategyKind> {};
INSTANTIATE_TEST_SUITE_P(All, MovingDrive, testing::ValuesIn(strategies::kAllStrategies), name_of_strategy);

// The images of every strategy have the bits of a timeline that takes the lists in the order of measurement, placed by the
// whole way.
TEST_P(MovingDrive, LateListsGiveTheBitsOfArrivalInOrder) {
  const Moving drive = drawn_moving(0, 3000, 30);
  const auto strategy = make_strategy(GetParam(), drive.config, laser_and_camera());
  run_moving(*strategy, drive, 3200, [](std::int64_t, const EgoPath&) {});

  EgoPath path(*drive.config.odometry);
  for (const OdometrySample& sample : drive.samples) path.accept(sample);
  std::vector<Unplaced> lists = drive.lists;
  std::sort(lists.begin(), lists.end(), [](const Unplaced& a, const Unplaced& b) {
    return tracks::before(a.id, at_ms(a.measured_ms), b.id, at_ms(b.measured_ms));
  });
  EXPECT_FALSE(std::is_sorted(drive.lists.begin(), drive.lists.end(),
                              [](const auto& a, const auto& b) { return a.measured_ms < b.measured_ms; }));
  tracks::Timeline timeline(drive.config, drive.config.max_observations);
  for (Unplaced& list : lists) {
    const EgoState ego = path.at(at_ms(list.measured_ms)).value();
    place_all(list, drive.config.sensors, ego);
    timeline.insert({list.id, at_ms(list.measured_ms), list.observations, ego.vehicle});
  }
  std::vector<tracks::TrackView> expected, image;
  for (const tracks::Track& track : timeline.current().tracks)
    if (track.confirmed) expected.push_back(shown(track, timeline.current().time, at_ms(3100), drive.config));
  strategy->image(at_ms(3100), image);
  EXPECT_EQ(image.size(), standing_objects().size());
  EXPECT_TRUE(same_bits(image, expected));
}

// The methods that are exact for a single state stay so.
TEST(MovingDrive, ExactMethodsEqualRewinding) {
  Moving drive = drawn_moving(1, 3000, 30);
  std::vector<tracks::TrackView> rewound, image;
  for (const oosm::Kind late : {oosm::Kind::kRewind, oosm::Kind::kAugmented, oosm::Kind::kClone}) {
    drive.config.late = late;
    const auto strategy = make_strategy(StrategyKind::kAdva, drive.config, laser_and_camera());
    run_moving(*strategy, drive, 3200, [](std::int64_t, const EgoPath&) {});
    strategy->image(at_ms(3100), image);
    EXPECT_EQ(image.size(), standing_objects().size());
    if (late == oosm::Kind::kRewind) rewound = image;
    for (std::size_t i = 0; i < std::min(image.size(), rewound.size()); ++i) {
      EXPECT_LT((image[i].state - rewound[i].state).norm(), 1e-9 * rewound[i].state.norm()) << oosm::name_of(late);
      EXPECT_LT((image[i].covariance - rewound[i].covariance).norm(), 1e-9 * rewound[i].covariance.norm());
    }
  }
}

// Mean NEES of (x, y, vx, vy) of the images from 1.5 s on, predicted by 40 ms; 4 where the covariance is right.
struct Judged {
  double nees = 0.0;
  int images = 0, objects = 0;
  double speed = 0.0;  // [m/s], mean error of the velocity
};
Judged judge_moving(StrategyKind kind, std::uint32_t drives, const config::TrackerConfig* reported = nullptr) {
  static const Vehicle kVehicle(6.0);
  Judged judged;
  for (std::uint32_t replication = 0; replication < drives; ++replication) {
    Moving drive = drawn_moving(replication, 4000, 5);
    if (reported) drive.config = *reported;
    const auto strategy = make_strategy(kind, drive.config, laser_and_camera());
    std::vector<tracks::TrackView> image;
    run_moving(*strategy, drive, 4000, [&](std::int64_t now, const EgoPath& path) {
      if (now < 1500 || now % 100 != 0) return;
      const std::int64_t use = now + 40;
      strategy->image(at_ms(use), image);
      ++judged.images;
      for (tracks::TrackView& view : image) {
        to_own_axes(view, path.at(at_ms(use)).value(), path.errors());
        double nearest = 4.0;
        linear::Vector<4> error = linear::Vector<4>::Zero();
        for (const linear::Vector<2>& object : standing_objects()) {
          const linear::Vector<2> off = view.state.head<2>() - kVehicle.seen(object, seconds_of(use));
          if (off.norm() >= nearest) continue;
          nearest = off.norm();
          error << off, view.state.segment<2>(2);
        }
        if (nearest >= 4.0) continue;
        ++judged.objects;
        judged.nees += error.dot(view.covariance.topLeftCorner<4, 4>().ldlt().solve(error));
        judged.speed += error.tail<2>().norm();
      }
    });
  }
  judged.nees /= judged.objects;
  judged.speed /= judged.objects;
  return judged;
}

TEST_P(MovingDrive, AStandingObjectStaysWithinItsEllipse) {
  const Judged judged = judge_moving(GetParam(), 40);
  EXPECT_EQ(judged.objects, judged.images * 4) << "each object is in each image";
  EXPECT_GT(judged.nees, 1.5);
  EXPECT_LT(judged.nees, 4.5);
  EXPECT_LT(judged.speed, 0.5);
}

TEST(MovingDrive, UnsaidErrorsOfOdometryAreTooLittle) {
  config::TrackerConfig config = config_of_moving();
  config.odometry->yaw_rate_bias_sigma = config.odometry->speed_scale_sigma = 0.0;
  EXPECT_GT(judge_moving(StrategyKind::kTt, 40, &config).nees, 5.0);
}

TEST(MovingDrive, AllocatesNothing) {
  const Moving drive = drawn_moving(2, 1000, 5);
  EgoPath path(*drive.config.odometry);
  for (const OdometrySample& sample : drive.samples) path.accept(sample);
  const auto strategy = make_strategy(StrategyKind::kAdva, drive.config, laser_and_camera());
  std::vector<tracks::TrackView> image;
  image.reserve(25);
  std::vector<Unplaced> lists = drive.lists;
  const std::int64_t before = support::allocations();
  for (Unplaced& list : lists) {
    const EgoState ego = path.at(at_ms(list.measured_ms)).value();
    place_all(list, drive.config.sensors, ego);
    strategy->accept({list.id, at_ms(list.measured_ms), list.observations, ego.vehicle});
    strategy->fuse(at_ms(list.ms));
    strategy->image(at_ms(list.ms + 40), image);
    for (tracks::TrackView& view : image) to_own_axes(view, path.at(view.valid_at).value(), path.errors());
  }
  EXPECT_EQ(support::allocations() - before, 0);
  EXPECT_EQ(image.size(), standing_objects().size());
}

// A moving sensor's field moves with it: an object beside the vehicle, which the sensor has passed, is missed by no list.
TEST(MovingDrive, FieldsMoveWithTheVehicle) {
  config::TrackerConfig config = config_of_moving();
  config.sensors[0].field = {.half_angle = 0.5, .max_range = 100.0};
  tracks::Tracker tracker(config, 4);
  tracks::TrackSet set(tracker.max_tracks());
  const auto step = [&](std::uint32_t k, double x, std::vector<sensors::Observation> seen) {
    const sensors::Mounting vehicle{.position = {x, 0.0}, .velocity = {10.0, 0.0}};
    for (sensors::Observation& z : seen) z.sensor = SensorId{0};
    tracker.step(set, {{SensorId{0}, k}, at_ms(40 * k), seen, vehicle});
  };
  for (std::uint32_t k = 0; k < 4; ++k) step(k, 0.4 * k, {position(30.0, 5.0, 0.1)});
  ASSERT_EQ(set.tracks.size(), 1u);
  EXPECT_TRUE(set.tracks[0].confirmed);
  step(4, 28.0, {});
  EXPECT_EQ(set.tracks[0].misses, 0) << "it is beside the vehicle";
  step(5, 2.0, {});
  EXPECT_EQ(set.tracks[0].misses, 1) << "it is ahead";
}

// A time stamp's error moves the sensor, too: by differences, against what the sensor sees at the later instant.
TEST(TimeStampBias, MovesTheSensorToo) {
  const sensors::Mounting vehicle{.position = {10.0, 5.0}, .yaw = 0.4, .yaw_rate = 0.5, .velocity = {7.0, 3.0}};
  const sensors::Mounting sensor = placed_on(vehicle, {.position = {3.5, 0.5}, .yaw = 0.2});
  const motion::Kinematics object{.position = {40.0, 25.0}, .velocity = {-2.0, 4.0}};
  constexpr double kLater = 1e-5;
  motion::Kinematics later = object;
  later.position += kLater * later.velocity;
  sensors::Mounting moved = sensor;
  moved.position += kLater * moved.velocity;
  moved.yaw += kLater * moved.yaw_rate;
  const auto in_sensor = [](const motion::Kinematics& k, const sensors::Mounting& from) {
    return sensors::turned(k.position - from.position, -from.yaw);
  };
  sensors::OwnBiases own;
  own.index = {-1, -1, -1, 0};

  // The position is placed by the pose at the stamp.
  const linear::Vector<2> placed = sensor.position + sensors::turned(in_sensor(later, moved), sensor.yaw);
  const auto by_time = sensors::AmongBiases<sensors::Position>{{}, own, sensor}.bias_jacobian(object);
  EXPECT_LT(((placed - object.position) / kLater - by_time.col(0)).norm(), 1e-3);

  using Radar = sensors::Mounted<sensors::RangeBearingRate>;
  const linear::Vector<3> z = Radar(sensor).expected(object), z_later = Radar(moved).expected(later);
  const auto of_radar = sensors::AmongBiases<Radar>{Radar(sensor), own, sensor}.bias_jacobian(object);
  EXPECT_LT(((z_later - z) / kLater - of_radar.col(0)).norm(), 1e-3);
}

}  // namespace
}  // namespace ttf::fusion::ego
