// Time to collision and time gap by their textbook definitions, ISO 15623 and ISO 15622.
#include "nodes/service/feature_service.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fusion/tracks/body/extent.h"

namespace ttf::nodes::service {
namespace {

constexpr double kPi = std::numbers::pi;

recording::records::ImageObject car(double x, double y, double heading, double speed) {
  recording::records::ImageObject object;
  object.x = x;
  object.y = y;
  object.heading = heading;
  object.speed = speed;
  object.length = 4.0;
  object.width = 2.0;
  object.status = recording::records::ImageStatus::kConfirmed | recording::records::ImageStatus::kHasLength |
                  recording::records::ImageStatus::kHasWidth;
  return object;
}
FeatureConfig driving(double own_speed) {
  FeatureConfig config;
  config.own_speed_mps = own_speed;
  return config;
}

// Rear edge 20 m ahead, closing with 10 m/s: 2 s, whichever of the two moves.
TEST(FeatureService, TimeToCollisionIsClearanceByClosingSpeed) {
  for (const double own : {0.0, 10.0, 25.0}) {
    const recording::records::FeatureObject f = judge(car(22.0, 0.0, kPi, 10.0), driving(own));
    EXPECT_NEAR(f.time_to_collision_s, 2.0, 1e-12)
        << "own speed " << own << ": the image's velocity is relative already";
    EXPECT_TRUE(f.warning);
  }
}

TEST(FeatureService, TimeGapIsClearanceByOwnSpeed) {
  // Following at the same speed: no closing, no collision, 20 m at 10 m/s.
  const recording::records::FeatureObject f = judge(car(22.0, 0.0, 0.0, 0.0), driving(10.0));
  EXPECT_NEAR(f.time_gap_s, 2.0, 1e-12);
  EXPECT_TRUE(std::isinf(f.time_to_collision_s));
  EXPECT_FALSE(f.warning);
  EXPECT_TRUE(std::isinf(judge(car(22.0, 0.0, 0.0, 0.0), driving(0.0)).time_gap_s)) << "who stands has no gap";
  EXPECT_TRUE(std::isinf(judge(car(-22.0, 0.0, 0.0, 0.0), driving(10.0)).time_gap_s)) << "nor what is behind";
}

// With odometry the image is over ground: the same cases as above.
TEST(FeatureService, OdometryMakesVelocitiesRelative) {
  const auto moving = [](double heading, double speed, double own) {
    return judge(car(22.0, 0.0, heading, speed), driving(3.0), own);
  };
  EXPECT_NEAR(moving(0.0, 0.0, 10.0).time_to_collision_s, 2.0, 1e-12) << "a standing car";
  EXPECT_NEAR(moving(0.0, 0.0, 10.0).time_gap_s, 2.0, 1e-12);
  EXPECT_NEAR(moving(kPi, 10.0, 10.0).time_to_collision_s, 1.0, 1e-12) << "an oncoming one";
  EXPECT_TRUE(std::isinf(moving(0.0, 10.0, 10.0).time_to_collision_s)) << "one ahead, as fast";
  EXPECT_NEAR(moving(0.0, 10.0, 10.0).time_gap_s, 2.0, 1e-12);
  EXPECT_NEAR(moving(kPi, 10.0, 0.0).time_to_collision_s, 2.0, 1e-12) << "and a standing car of one's own";
}

TEST(FeatureService, AnOpeningOrConstantGapIsNoCollision) {
  EXPECT_TRUE(std::isinf(judge(car(22.0, 0.0, 0.0, 5.0), driving(0.0)).time_to_collision_s));
  EXPECT_TRUE(std::isinf(judge(car(22.0, 0.0, kPi, 0.4), driving(0.0)).time_to_collision_s)) << "noise about zero";
  EXPECT_NEAR(judge(car(22.0, 0.0, kPi, 0.6), driving(0.0)).time_to_collision_s, 20.0 / 0.6, 1e-9);
}

// 30 m away under 30 degrees, driving straight at the sensor: along the line of sight, not along x.
TEST(FeatureService, ClosesAlongTheLineOfSight) {
  const double bearing = kPi / 6.0;
  const recording::records::FeatureObject f =
      judge(car(30.0 * std::cos(bearing), 30.0 * std::sin(bearing), bearing + kPi, 7.0), driving(0.0));
  EXPECT_NEAR(f.time_to_collision_s, 28.0 / 7.0, 1e-9);
  EXPECT_FALSE(f.warning) << "15 m beside the line of travel";
}

// The near edge: the rear of a car ahead, the side of a crossing one; in between, where the line of sight
// meets it.
TEST(FeatureService, ClearanceEndsAtTheOutline) {
  const auto clearance = [](double heading) {
    return 10.0 * judge(car(22.0, 0.0, heading, 0.0), driving(10.0)).time_gap_s;
  };
  EXPECT_NEAR(clearance(0.0), 20.0, 1e-9);
  EXPECT_NEAR(clearance(kPi), 20.0, 1e-9);
  EXPECT_NEAR(clearance(kPi / 2), 21.0, 1e-9);
  EXPECT_NEAR(clearance(kPi / 4), 22.0 - std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(clearance(0.3), 22.0 - 2.0 / std::cos(0.3), 1e-9);
  EXPECT_EQ(10.0 * judge(car(1.0, 0.0, 0.0, 0.0), driving(10.0)).time_gap_s, 0.0) << "within the outline";
}

TEST(FeatureService, UnmeasuredSizesAreThoseOfTheImage) {
  recording::records::ImageObject object = car(22.0, 0.0, 0.0, 0.0);
  object.status = recording::records::ImageStatus::kConfirmed;
  object.length = 4.4;
  object.width = 1.8;
  EXPECT_NEAR(10.0 * judge(object, driving(10.0)).time_gap_s, 22.0 - 0.5 * object.length, 1e-9);
  object.heading = kPi / 2;
  EXPECT_NEAR(10.0 * judge(object, driving(10.0)).time_gap_s, 22.0 - 0.5 * object.width, 1e-9);
}

TEST(FeatureService, WarnsInTheCorridorOnly) {
  FeatureConfig config;
  config.warning_time_s = 2.5;
  EXPECT_TRUE(judge(car(22.0, 1.7, kPi, 10.0), config).warning);
  EXPECT_FALSE(judge(car(22.0, 1.9, kPi, 10.0), config).warning);
  EXPECT_FALSE(judge(car(32.0, 0.0, kPi, 10.0), config).warning) << "3 s";
  EXPECT_FALSE(judge(car(-22.0, 0.0, 0.0, 10.0), config).warning) << "behind";
}

}  // namespace
}  // namespace ttf::nodes::service
