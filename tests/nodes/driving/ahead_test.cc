// The object ahead without new images, and new tracks.
#include "nodes/driving/ahead.h"

#include <gtest/gtest.h>

#include <vector>

#include "nodes/driving/adaptive_cruise_control.h"
#include "nodes/driving/emergency_braking.h"
#include "nodes/driving/known_tracks.h"
#include "tests/nodes/driving/service_by_hand.h"

namespace ttf::nodes::driving {
namespace {

using namespace recording::records;

// Closed forms: 10 m/s, and 4 m/s^2 of braking.
TEST(ObjectAhead, IsPredictedUntilItStands) {
  const ObjectAhead seen{TrackId{7}, 30.0, 10.0, -4.0};
  const ObjectAhead soon = predicted(seen, 0.5, 6.0);
  EXPECT_NEAR(soon.clearance, 30.0 + 5.0 - 0.5 - 6.0, 1e-12);
  EXPECT_NEAR(soon.speed, 8.0, 1e-12);
  EXPECT_EQ(soon.acceleration, -4.0);
  const ObjectAhead stands = predicted(seen, 4.0, 6.0);  // after 2.5 s and 12.5 m
  EXPECT_NEAR(stands.clearance, 30.0 + 12.5 - 6.0, 1e-12);
  EXPECT_EQ(stands.speed, 0.0);
  EXPECT_EQ(stands.acceleration, 0.0);
  const ObjectAhead noise = predicted({TrackId{7}, 30.0, 0.0, -4.0}, 0.5, 0.0);
  EXPECT_EQ(noise.clearance, 30.0) << "what stands does not begin to drive backwards";
  EXPECT_EQ(noise.speed, 0.0);
  const ObjectAhead oncoming = predicted({TrackId{7}, 30.0, -5.0, 3.0}, 0.4, 2.0);
  EXPECT_NEAR(oncoming.clearance, 30.0 - 2.0 - 2.0, 1e-12);
}

// Images stop. The vehicle at 20 m/s approaches a car that brakes by 4 m/s^2 from 20 m/s.
template <class Service, class Config> struct WithoutImages : ServiceByHand {
  WithoutImages(const char* name, const Config& config)
      : ServiceByHand(task_there("feature", name)), step(surround(), task_there("feature", name), config) {
    receive("image", {{{"id", 7},
                       {"x", 45.4},
                       {"y", 0},
                       {"heading", 0},
                       {"speed", 20},
                       {"acceleration", -4},
                       {"length", 4},
                       {"width", 1.8},
                       {"status", 1}}});
    drive();
  }
  void drive(double own_speed = 20.0) {
    receive("odometry", {{{"speed", own_speed}, {"yaw_rate", 0}}});
    run(step);
  }
  Service step;
};

TEST(AdaptiveCruiseControl, PredictsTheCarAheadForAWhile) {
  WithoutImages<AdaptiveCruiseControl, CruiseConfig> service("adaptive_cruise_control", {});
  EXPECT_NEAR(service.issued->gap, 40.0, 0.01);
  // The image's heading is off by less than a step of its code.
  for (int execution = 1; execution <= 12; ++execution) {
    service.drive();
    const double t = 0.04 * execution;
    ASSERT_TRUE(service.issued->valid) << execution;
    EXPECT_EQ(service.issued->track, TrackId{7});
    EXPECT_NEAR(service.issued->gap, 40.0 - 2.0 * t * t, 0.01) << execution;
    EXPECT_NEAR(service.issued->speed_ahead, 20.0 - 4.0 * t, 0.01) << execution;
  }
  service.drive();
  EXPECT_FALSE(service.issued->valid) << "after 520 ms";
}

// The own way is the integral of the speed, by the trapezoidal rule: 10 m/s, then 6 m/s.
TEST(AdaptiveCruiseControl, PredictsWithItsOwnWay) {
  WithoutImages<AdaptiveCruiseControl, CruiseConfig> service("adaptive_cruise_control", {});
  service.drive(10.0);
  service.drive(6.0);
  const double own = 0.04 * 15.0 + 0.04 * 8.0;
  EXPECT_NEAR(service.issued->gap, 40.0 + 20.0 * 0.08 - 2.0 * 0.08 * 0.08 - own, 0.01);
}

TEST(AdaptiveCruiseControl, WithoutPredictionItsViewEndsWithTheImage) {
  CruiseConfig config;
  config.path.prediction = Duration{};
  WithoutImages<AdaptiveCruiseControl, CruiseConfig> service("adaptive_cruise_control", config);
  for (int execution = 1; execution <= 3; ++execution) {
    service.drive();
    EXPECT_EQ(service.issued->valid, execution <= 2) << execution;
  }
}

// 2.7 s to a collision at 4 m/s^2 for constant speeds: 40 - 2 t^2 = 2.7 * 4 t, so that t is 2.53 s. An image is not
// that old.
TEST(EmergencyBraking, WarnsByAPredictedCar) {
  EmergencyConfig config;
  config.path.prediction = Duration::milliseconds(3'000);
  WithoutImages<EmergencyBraking, EmergencyConfig> service("emergency_braking", config);
  for (int execution = 1; execution <= 63; ++execution) service.drive();  // 2.52 s
  EXPECT_TRUE(service.warnings.empty());
  service.drive();
  ASSERT_EQ(service.warnings.size(), 1u);
  EXPECT_EQ(service.warnings[0].service, WarningKind::kForwardCollision);
  EXPECT_NEAR(service.warnings[0].time_to_collision_s, (40.0 - 2.0 * 2.56 * 2.56) / (4.0 * 2.56), 0.01);
}

// A car at 60 m keeps the speed of 20 m/s. A second track of it begins with the tracker's prior, a speed of zero.
TEST(EmergencyBraking, ANewTrackBeginsNothing) {
  const schedules::model::Task& task = task_there("feature", "emergency_braking");
  using Element = ServiceByHand::Element;
  const auto object = [](double id, double x, double speed) {
    return Element{{"id", id},       {"x", x},      {"y", 0},       {"heading", 0},
                   {"speed", speed}, {"length", 4}, {"width", 1.8}, {"status", 1}};
  };
  const Element car = object(7, 60, 20), second = object(8, 42, 0);
  EmergencyBraking step(surround(), task, {});
  ServiceByHand service(task);
  const auto see = [&](const std::vector<Element>& objects) {
    service.receive("image", objects);
    service.receive("odometry", {{{"speed", 20.0}, {"yaw_rate", 0.0}}});
    service.run(step);
  };
  for (int image = 0; image < 5; ++image) see({car});
  for (int image = 0; image < 3; ++image) see({second, car});  // for 80 ms
  EXPECT_TRUE(service.warnings.empty());
  EXPECT_EQ(service.issued->track, TrackId{7}) << "the other one is ahead meanwhile";
  see({car});
  for (int image = 0; image < 3; ++image) see({second, car});
  EXPECT_TRUE(service.warnings.empty()) << "it begins anew";
  see({second, car});
  ASSERT_EQ(service.warnings.size(), 1u) << "it stays: it is an object";
  EXPECT_EQ(service.warnings[0].track, TrackId{8});
  see({object(9, 42, 0), car});
  EXPECT_EQ(service.warnings.size(), 1u) << "a warning goes on with a track that is born again";
}

TEST(KnownTracks, CountsImagesInARow) {
  KnownTracks known(2);
  const auto image = [&](std::int64_t ms, const std::vector<int>& tracks) {
    known.begin(LocalTime{} + Duration::milliseconds(ms));
    for (const int track : tracks) known.add(TrackId{static_cast<std::uint16_t>(track)});
  };
  image(0, {1});
  EXPECT_EQ(known.known_for(TrackId{1}), KnownTracks::kLong) << "it is no second one";
  EXPECT_EQ(known.known_for(TrackId{2}), Duration{});
  image(40, {2, 1});
  image(90, {1, 2});
  EXPECT_EQ(known.known_for(TrackId{1}), KnownTracks::kLong + Duration::milliseconds(90));
  EXPECT_EQ(known.known_for(TrackId{2}), Duration::milliseconds(50));
  image(130, {2});
  EXPECT_EQ(known.known_for(TrackId{1}), Duration{});
  image(170, {1, 2, 3});
  EXPECT_EQ(known.known_for(TrackId{1}), Duration{}) << "it was away";
  EXPECT_EQ(known.known_for(TrackId{2}), Duration::milliseconds(130));
  image(210, {});
  image(250, {3});
  EXPECT_GT(known.known_for(TrackId{3}), Duration::milliseconds(1'000));
}

}  // namespace
}  // namespace ttf::nodes::driving
