// A track's fields in an image.
#include "fusion/tracks/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks {
namespace {

Track moving_track(double vx, double vy, double sigma_v) {
  Track track;
  const double v = sigma_v * sigma_v;
  track.estimate =
      linear::Gaussian<4>{linear::Vector<4>(10.0, 2.0, vx, vy), linear::Vector<4>(0.1, 0.1, v, v).asDiagonal()};
  return track;
}

TEST(View, CourseGivesTheHeadingOfAMovingTrack) {
  const Track track = moving_track(-3.0, 4.0, 0.5);
  const TrackView view = shown(track, at_ms(0), at_ms(0));
  EXPECT_NEAR(view.heading, std::atan2(4.0, -3.0), 1e-12);
  EXPECT_NEAR(view.sigma_heading, 0.5 / 5.0, 1e-12);
  EXPECT_NEAR(view.speed, 5.0, 1e-12);
  EXPECT_NEAR(view.sigma_speed, 0.5, 1e-12);
}

TEST(View, AxisGivesTheHeadingOfAStandingTrackAndCourseGivesItsFront) {
  Track standing = moving_track(0.01, 0.0, 0.5);
  standing.heading = {{2.0, 0.01, true}};
  EXPECT_NEAR(shown(standing, at_ms(0), at_ms(0)).heading, 2.0, 1e-12);
  // Driving along +x with an axis measured half a turn off: turned towards the direction of travel.
  Track driving = moving_track(10.0, 0.0, 1.0);
  driving.heading = {{std::numbers::pi - 0.2, 0.01, true}};  // course variance is 0.01 too
  const TrackView view = shown(driving, at_ms(0), at_ms(0));
  EXPECT_NEAR(view.heading, -0.1, 1e-12);
  EXPECT_NEAR(view.sigma_heading, std::sqrt(0.005), 1e-12);
  Track unknown = moving_track(0.0, 0.0, 0.5);
  EXPECT_NEAR(shown(unknown, at_ms(0), at_ms(0)).sigma_heading, std::numbers::pi / std::sqrt(3.0), 1e-12);
}

TEST(View, SigmaContainsTheDoubtWhichEndIsTheFront) {
  constexpr double kPi = std::numbers::pi;
  Track track = moving_track(0.0, 0.0, 0.5);
  track.heading = {{0.2, 0.01, true}};
  EXPECT_NEAR(shown(track, at_ms(0), at_ms(0)).sigma_heading, std::sqrt(0.01 + 0.5 * kPi * kPi), 1e-12);
  // A course of two standard deviations is wrong once in 44 times, by the normal distribution's table.
  track = moving_track(-1.0, 0.0, 0.5);
  track.heading = {{0.0, 0.01, true}};
  const TrackView backwards = shown(track, at_ms(0), at_ms(0));
  EXPECT_NEAR(std::abs(backwards.heading), kPi, 1e-12);
  EXPECT_NEAR(backwards.sigma_heading, std::sqrt(0.25 * 0.01 / 0.26 + 0.02275 * kPi * kPi), 1e-4);
  // Against what is remembered, it is noise.
  track.heading.front = 1;
  const TrackView remembered = shown(track, at_ms(0), at_ms(0));
  EXPECT_NEAR(remembered.heading, 0.0, 1e-12);
  EXPECT_NEAR(remembered.sigma_heading, 0.1, 1e-12);
}

TEST(View, AccelerationIsAlongTheHeading) {
  config::TrackerConfig config;
  config.motion = config::MotionModel::kConstantAcceleration;
  Track track = moving_track(0.0, 10.0, 0.1);
  linear::Gaussian<6> accelerating = seen_as(track.estimate);
  accelerating.x.tail<2>() << 5.0, -2.0;
  accelerating.p(4, 4) = 9.0;
  accelerating.p(5, 5) = 0.25;
  track.estimate = accelerating;
  const TrackView view = shown(track, at_ms(0), at_ms(0), config);
  EXPECT_NEAR(view.acceleration, -2.0, 1e-12) << "braking; what points sideways does not count";
  EXPECT_NEAR(view.sigma_acceleration, 0.5, 1e-9);
}

TEST(View, IsPredictedButNeverBackwards) {
  const config::TrackerConfig config;
  Track track = moving_track(2.0, -1.0, 0.5);
  track.extent.size(0) = 4.0;
  track.extent.covariance(0, 0) = 0.04;
  const TrackView later = shown(track, at_ms(1000), at_ms(1500), config);
  EXPECT_NEAR(later.state(0), 11.0, 1e-12);
  EXPECT_NEAR(later.state(1), 1.5, 1e-12);
  EXPECT_NEAR(later.covariance(0, 0), 0.1 + 0.25 * 0.25 + 3.0 * 0.125 / 3.0, 1e-12);
  EXPECT_NEAR(later.sigma_length, 0.2, 1e-12);
  EXPECT_EQ(later.valid_at, at_ms(1500));
  const TrackView earlier = shown(track, at_ms(1000), at_ms(900), config);
  EXPECT_EQ(earlier.state, state_of(track));
  EXPECT_EQ(earlier.valid_at, at_ms(1000)) << "the instant its state is of";
}

}  // namespace
}  // namespace ttf::fusion::tracks
