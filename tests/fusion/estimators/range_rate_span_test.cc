// Range rates that a radar measures up to multiples of a span.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fusion/estimators/estimator.h"
#include "fusion/sensors/known_sensor.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::estimators {
namespace {

constexpr auto kStraight = config::MotionModel::kConstantVelocity;

Estimate coming(double speed, double sigma) {
  State x = State::Zero();
  x << 60.0, 5.0, -speed, 0.0, 0.0, 0.0;
  Covariance p = Covariance::Zero();
  p.diagonal() << 1.0, 1.0, sigma * sigma, sigma * sigma, 0.0, 0.0;
  return estimate_of(kStraight, x, p);
}

// As seen from the origin.
sensors::Observation seen(double x, double y, double speed, double span) {
  const double range = std::hypot(x, y), rate = -speed * x / range;
  sensors::Observation z = radar(range, std::atan2(y, x), std::remainder(rate, span), 0.2, 0.005, 0.1);
  z.rate_span = span;
  return z;
}

TEST(RangeRateSpan, AFoldedRateUpdatesAsTheRateItself) {
  const auto estimator = make_estimator(config_of(kStraight));
  const sensors::Observation folded = seen(60.0, 5.0, 31.0, 40.0);
  sensors::Observation whole = folded;
  whole.z(2) = -31.0 * 60.0 / std::hypot(60.0, 5.0);
  whole.rate_span = sensors::Observation{}.rate_span;
  ASSERT_GT(folded.z(2), 0.0);
  Estimate by_folded = coming(30.0, 1.0), by_whole = by_folded;
  EXPECT_NEAR(estimator->distance_squared(by_folded, folded).value(),
              estimator->distance_squared(by_whole, whole).value(), 1e-9);
  estimator->update(by_folded, folded);
  estimator->update(by_whole, whole);
  EXPECT_LT((seen_as(by_folded).x - seen_as(by_whole).x).norm(), 1e-9);
  EXPECT_NEAR(seen_as(by_folded).x(2), -31.0, 0.2);
}

TEST(RangeRateSpan, AnUncertainVelocityTakesNoRate) {
  const auto estimator = make_estimator(config_of(kStraight));
  Estimate estimate = coming(30.0, 10.0);
  estimator->update(estimate, seen(60.0, 5.0, 40.0, 40.0));
  EXPECT_NEAR(seen_as(estimate).x(2), -30.0, 0.01);
  EXPECT_NEAR(seen_as(estimate).p(2, 2), 100.0, 0.1);
  EXPECT_LT(seen_as(estimate).p(0, 0), 0.1) << "range and bearing count";
}

TEST(RangeRateSpan, TheGateRefusesOtherRates) {
  const auto estimator = make_estimator(config_of(kStraight));
  const Estimate estimate = coming(30.0, 1.0);
  EXPECT_LT(estimator->distance_squared(estimate, seen(60.0, 5.0, 30.0, 40.0)).value(), 1.0);
  EXPECT_GT(estimator->distance_squared(estimate, seen(60.0, 5.0, 40.0, 40.0)).value(), 50.0);
}

// 45 m/s are measured as 15 m/s away. The first lists' positions say which it is.
TEST(RangeRateSpan, AFastObjectFindsItsSpeed) {
  config::TrackerConfig config = config_of(kStraight, 1.0);
  config.initial_velocity_sigma = 20.0;
  config.sensors.resize(1);
  config.sensors[0].range_rate_span = 60.0;
  RandomStream noise({1, 0, Purpose::kTest, 0, 0});
  tracks::Tracker tracker(config, 4);
  tracks::TrackSet set(tracker.max_tracks());

  for (int k = 0; k < 30; ++k) {
    const double x = 120.0 - 45.0 * 0.04 * k;
    sensors::Observation z = seen(x, 5.0, 45.0, 60.0);
    z.z += Eigen::Vector3d(0.2 * noise.normal(), 0.005 * noise.normal(), 0.1 * noise.normal());
    sensors::place(z, SensorId{0}, config.sensors[0]);
    EXPECT_EQ(z.rate_span, 60.0);
    const std::vector<sensors::Observation> list{z};
    tracker.step(set, {{SensorId{0}, static_cast<std::uint32_t>(k)}, at_ms(40 * k), list});
  }
  ASSERT_EQ(set.tracks.size(), 1U);
  const State x = state_of(set.tracks[0]);
  EXPECT_NEAR(x(2), -45.0, 0.3);
}

}  // namespace
}  // namespace ttf::fusion::estimators
