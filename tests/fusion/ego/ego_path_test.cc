#include "fusion/ego/ego_path.h"

#include <gtest/gtest.h>

#include <cstring>
#include <optional>

#include "fusion/estimators/estimator.h"
#include "fusion/sensors/known_sensor.h"
#include "fusion/sensors/range_bearing_rate.h"
#include "tests/fusion/ego/vehicle.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::ego {
namespace {

bool same(const EgoState& a, const EgoState& b) {
  return a.vehicle.position == b.vehicle.position && a.vehicle.yaw == b.vehicle.yaw &&
         a.vehicle.velocity == b.vehicle.velocity && a.vehicle.yaw_rate == b.vehicle.yaw_rate &&
         a.along_variance == b.along_variance && a.turn_variance == b.turn_variance && a.behind == b.behind;
}

TEST(EgoPath, FollowsExactSamples) {
  const Vehicle vehicle(5.0);
  EgoPath path({});
  for (std::int64_t ms = 0; ms <= 4000; ms += 20) path.accept(exact_sample(ms));
  for (const std::int64_t ms : {0, 7, 990, 1001, 1250, 1513, 2345, 3999, 4000}) {
    const EgoState ego = path.at(at_ms(ms)).value();
    const sensors::Mounting truth = vehicle.at(seconds_of(ms));
    EXPECT_LT((ego.vehicle.position - truth.position).norm(), 1e-9) << ms;
    EXPECT_NEAR(ego.vehicle.yaw, truth.yaw, 1e-12) << ms;
    EXPECT_NEAR(ego.vehicle.yaw_rate, truth.yaw_rate, 1e-12) << ms;
    EXPECT_LT((ego.vehicle.velocity - truth.velocity).norm(), 1e-10) << ms;
    EXPECT_EQ(ego.along_variance, 0.0);
    EXPECT_EQ(ego.turn_variance, 0.0);
  }
}

// A radius of 20 m at 8 m/s and 0.4 rad/s; beyond the newest sample, too, for more than a radian.
TEST(EgoPath, GoesOnAlongAnArc) {
  EgoPath path({});
  for (std::int64_t ms = 0; ms <= 100; ms += 20) path.accept({at_ms(ms), 8.0, 0.4});
  for (const std::int64_t ms : {50, 100, 140, 1000, 6000}) {
    const double turned = 0.4 * seconds_of(ms);
    const EgoState ego = path.at(at_ms(ms)).value();
    EXPECT_NEAR(ego.vehicle.position.x(), 20.0 * std::sin(turned), 1e-11);
    EXPECT_NEAR(ego.vehicle.position.y(), 20.0 * (1.0 - std::cos(turned)), 1e-11);
    EXPECT_NEAR(ego.vehicle.yaw, turned, 1e-12);
  }
}

// At constant speed and yaw rate, the drift is the way without slip, turned by a quarter and times the slip angle.
TEST(EgoPath, DriftsOutwardsWhereTyresSlip) {
  OdometryErrors errors;
  errors.slip = 0.005;
  const double angle = -errors.slip * 8.0 * 0.4;
  for (const std::int64_t last : {100, 2000}) {  // beyond the newest sample, and among samples
    EgoPath plain({}), path(errors);
    for (std::int64_t ms = 0; ms <= last; ms += 20) {
      plain.accept({at_ms(ms), 8.0, 0.4});
      path.accept({at_ms(ms), 8.0, 0.4});
    }
    const sensors::Mounting without = plain.at(at_ms(1500))->vehicle, vehicle = path.at(at_ms(1500))->vehicle;
    const linear::Vector<2> drift(-without.position.y(), without.position.x());
    EXPECT_LT((vehicle.position - without.position - angle * drift).norm(), 1e-11) << last;
    EXPECT_NEAR(vehicle.yaw, without.yaw, 1e-15);
    const linear::Vector<2> left(-std::sin(vehicle.yaw), std::cos(vehicle.yaw));
    EXPECT_NEAR(left.dot(vehicle.velocity), 8.0 * angle, 1e-12);
  }
}

// Law 1.
TEST(EgoPath, IsFinalUntilTheNewestSample) {
  RandomStream draw({.seed = 1});
  const std::vector<OdometrySample> samples = drawn_samples({}, 2000, draw);
  EgoPath whole({});
  for (const OdometrySample& sample : samples) whole.accept(sample);
  EgoPath path({});
  for (const OdometrySample& sample : samples) {
    path.accept(sample);
    const EgoState now = path.at(sample.at).value();
    EXPECT_EQ(now.vehicle.position, whole.at(sample.at)->vehicle.position);
    EXPECT_EQ(now.vehicle.yaw, whole.at(sample.at)->vehicle.yaw);
    if (sample.at > at_ms(50)) {
      EXPECT_TRUE(same(path.at(sample.at - Duration::milliseconds(33)).value(),
                       whole.at(sample.at - Duration::milliseconds(33)).value()));
    }
  }
}

// Law 2.
TEST(EgoPath, RefusesSamplesThatAreNotNewer) {
  EgoPath path({});
  EXPECT_FALSE(path.at(at_ms(0)));
  EXPECT_TRUE(path.has_stopped(at_ms(0)));
  EXPECT_TRUE(path.accept({at_ms(40), 8.0, 0.1}));
  EXPECT_TRUE(path.accept({at_ms(60), 8.0, 0.1}));
  const EgoState before = path.at(at_ms(70)).value();
  EXPECT_FALSE(path.accept({at_ms(60), 1.0, 0.0}));
  EXPECT_FALSE(path.accept({at_ms(50), 1.0, 0.0}));
  EXPECT_TRUE(same(path.at(at_ms(70)).value(), before));
  EXPECT_FALSE(path.at(at_ms(39))) << "the frame begins with the first sample";
}

TEST(EgoPath, SubtractsKnownErrors) {
  OdometryErrors errors;
  errors.speed_scale = 0.02;
  errors.yaw_rate_bias = 0.01;
  EgoPath path(errors);
  path.accept({at_ms(0), 1.02 * 8.0, 0.31});
  EXPECT_NEAR(path.newest().speed, 8.0, 1e-12);
  EXPECT_NEAR(path.newest().yaw_rate, 0.3, 1e-12);
}

// The uncertainty grows, and the way through a long gap is the one that lists were placed by.
TEST(EgoPath, CoastsWhenTheOdometryStops) {
  EgoPath path({});
  path.accept({at_ms(0), 8.0, 0.4, 0.05, 0.002});
  EXPECT_FALSE(path.has_stopped(at_ms(200)));
  EXPECT_TRUE(path.has_stopped(at_ms(201)));
  EXPECT_NEAR(path.at(at_ms(100))->along_variance, 0.005 * 0.005 + 0.01 * 0.01, 1e-12);
  EXPECT_NEAR(path.at(at_ms(100))->turn_variance, 0.0002 * 0.0002 + 0.0025 * 0.0025, 1e-12);
  EXPECT_GT(path.at(at_ms(500))->along_variance, 0.05);
  const EgoState coasted = path.at(at_ms(300)).value();
  path.accept({at_ms(400), 4.0, 0.0});
  EXPECT_EQ(path.at(at_ms(300))->vehicle.position, coasted.vehicle.position);
  EXPECT_EQ(path.at(at_ms(300))->vehicle.yaw, coasted.vehicle.yaw);
  EXPECT_EQ(path.at(at_ms(300))->along_variance, 0.0) << "the frame is what the odometry says";
  EXPECT_FALSE(path.has_stopped(at_ms(500)));
}

// Law 3, and a memory of some seconds.
TEST(EgoPath, RemembersWithoutAllocation) {
  EgoPath path({});
  const std::int64_t before = support::allocations();
  for (std::int64_t ms = 0; ms < 50'000; ms += 20) path.accept({at_ms(ms), 8.0, 0.4});
  EXPECT_FALSE(path.at(at_ms(20'000)));
  EXPECT_TRUE(path.at(at_ms(30'000)));
  EXPECT_EQ(support::allocations() - before, 0);
}

// A sensor on a moving vehicle sees a standing object. Placed, the object is where it stands, whatever the sensor measures.
TEST(Carried, AStandingObjectIsWhereItStands) {
  const Vehicle vehicle(4.0);
  const linear::Vector<2> object(50.0, 20.0);
  sensors::KnownSensor sensor;
  sensor.mounting = {.position = {3.5, -0.4}, .yaw = 0.3};
  EgoPath path({});
  for (std::int64_t ms = 0; ms <= 3000; ms += 20) path.accept(exact_sample(ms));
  const EgoState ego = path.at(at_ms(2510)).value();
  const linear::Vector<2> seen =
      sensors::turned(vehicle.seen(object, 2.51) - sensor.mounting.position, -sensor.mounting.yaw);

  sensors::Observation z = position(seen.x(), seen.y(), 0.2);
  z.r(0, 0) = 0.01;
  z.has_heading = true;
  z.heading = 1.0 - Vehicle::heading_at(2.51) - sensor.mounting.yaw;
  place(z, SensorId{1}, sensor);
  carry(z, ego);
  EXPECT_LT((z.z.head<2>() - object).norm(), 1e-9);
  EXPECT_NEAR(z.heading, 1.0, 1e-9);
  const linear::Vector<2> line = sensors::turned({1.0, 0.0}, Vehicle::heading_at(2.51) + sensor.mounting.yaw);
  EXPECT_NEAR(line.dot(z.r.topLeftCorner<2, 2>() * line), 0.01, 1e-9);

  // A radar on a vehicle at rest has no range rate from it; the vehicle's own motion makes one.
  const sensors::Mounting carried = placed_on(vehicle.at(2.51), sensor.mounting);
  const linear::Vector<2> sight = object - carried.position;
  sensors::Observation r =
      radar(seen.norm(), std::atan2(seen.y(), seen.x()), -carried.velocity.dot(sight) / sight.norm(), 0.2, 0.005, 0.1);
  place(r, SensorId{1}, sensor);
  carry(r, ego);
  const sensors::Mounted<sensors::RangeBearingRate> model(r.from);
  const motion::Kinematics standing{.position = object};
  EXPECT_LT(model.residual(r.z, model.expected(standing)).norm(), 1e-8);
  config::TrackerConfig config;
  const auto estimator = estimators::make_estimator(config);
  const estimators::Estimate first = estimator->initial(r);
  EXPECT_LT((estimator->position(first).x - object).norm(), 1e-8);
  EXPECT_LT(estimator->velocity(first).norm(), 1e-8);
  EXPECT_NEAR(estimator->distance_squared(first, r).value(), 0.0, 1e-12);
}

// Beyond the newest sample a list has the pose's uncertainty: by differences.
TEST(Carried, AnUncertainPoseAddsNoise) {
  EgoPath path({});
  path.accept({at_ms(0), 8.0, 0.0, 0.05, 0.002});
  const EgoState ego = path.at(at_ms(100)).value();
  sensors::Observation z = position(30.0, 10.0, 0.1), r = radar(30.0, 0.4, 0.0, 0.1, 0.01, 0.1);
  const Eigen::Matrix3d before = r.r;
  carry(z, ego);
  carry(r, ego);
  const linear::Vector<2> swing(-10.0, 30.0 + ego.behind);
  linear::Matrix<2> expected = linear::Matrix<2>::Identity() * 0.01 + ego.turn_variance * swing * swing.transpose();
  expected(0, 0) += ego.along_variance;
  EXPECT_LT((z.r.topLeftCorner<2, 2>() - expected).norm(), 1e-12);
  EXPECT_NEAR(r.r(1, 1) - before(1, 1), ego.turn_variance, 0.1 * ego.turn_variance);
  EXPECT_NEAR(r.r(0, 0) - before(0, 0), ego.along_variance * std::cos(0.4) * std::cos(0.4), 0.02 * ego.along_variance);
}

}  // namespace
}  // namespace ttf::fusion::ego
