// Headings that turn: exact steps, rates that are estimated, and axes that come late.
#include "fusion/tracks/body/heading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "fusion/motion/angles.h"

namespace ttf::fusion::tracks::body {
namespace {

Heading known(double value, double sigma) {
  Heading heading = unknown_heading({});
  correct(heading, value, sigma, value);
  return heading;
}

// Within a billionth: a rate without noise lasts for a billion seconds.
void expect_same(const Heading& a, const Heading& b) {
  constexpr double kSame = 1e-9;
  EXPECT_NEAR(a.value, b.value, kSame);
  EXPECT_NEAR(a.variance, b.variance, kSame);
  EXPECT_NEAR(a.rate, b.rate, kSame);
  EXPECT_NEAR(a.rate_variance, b.rate_variance, kSame);
  EXPECT_NEAR(a.covariance, b.covariance, kSame);
}

TEST(Heading, TwoStepsAreOne) {
  const config::TrackerConfig config;
  for (const double dt : {0.002, 0.05, 0.5, 3.0}) {
    Heading heading = known(0.4, 0.05);
    heading.rate = 0.2;
    heading.covariance = 0.003;
    expect_same(predicted(predicted(heading, config, 9.0, 0.3 * dt), config, 9.0, 0.7 * dt),
                predicted(heading, config, 9.0, dt));
    expect_same(predicted(heading, config, 9.0, 0.0), heading);
  }
}

// Mean of normalised squares over drawn turns: value and rate, together.
TEST(Heading, IsConsistentOverDrawnTurns) {
  constexpr int kDraws = 2000;
  const config::TrackerConfig config;
  const double s = config.initial_turn_rate_sigma, seconds = 2.0 * s * s / config.turn_noise, dt = 0.05, sigma = 0.03;
  double nees = 0.0, rate_error = 0.0;
  for (int k = 0; k < kDraws; ++k) {
    RandomStream draw({.seed = 21, .replication = static_cast<std::uint32_t>(k)});
    double angle = 3.0, rate = s * draw.normal();
    Heading heading = unknown_heading(config);
    for (int list = 0; list < 60; ++list) {
      if (list > 0) {
        constexpr int kParts = 10;
        for (int part = 0; part < kParts; ++part) {
          angle += rate * dt / kParts + std::sqrt(config.heading_noise * dt / kParts) * draw.normal();
          const double left = std::exp(-dt / kParts / seconds);
          rate = left * rate + s * std::sqrt(1.0 - left * left) * draw.normal();
        }
        heading = predicted(heading, config, 20.0, dt);
      }
      const double measured = motion::to_half_turn(angle + sigma * draw.normal());
      correct(heading, list % 2 ? measured : motion::to_half_turn(measured + std::numbers::pi), sigma, measured);
    }
    const double e = motion::to_half_turn(heading.value - angle), r = heading.rate - rate;
    const double determinant = heading.variance * heading.rate_variance - heading.covariance * heading.covariance;
    nees += (e * e * heading.rate_variance - 2.0 * e * r * heading.covariance + r * r * heading.variance) /
            determinant / kDraws;
    rate_error += r * r / kDraws;
  }
  EXPECT_NEAR(nees, 2.0, 0.2);
  EXPECT_LT(std::sqrt(rate_error), 0.6 * s) << "the rate is learned";
}

// A driving object loses it within some seconds.
TEST(Heading, IsKeptByWhatStands) {
  const config::TrackerConfig config;
  Heading standing = known(0.4, 0.02), driving = standing;
  standing.rate_variance = driving.rate_variance = 1e-4;
  standing = predicted(standing, config, 0.0, 3.0);
  driving = predicted(driving, config, 10.0, 3.0);
  EXPECT_LT(std::sqrt(standing.variance), 0.15);
  EXPECT_GT(std::sqrt(driving.variance), 0.4);
  EXPECT_NEAR(standing.value, 0.4, 1e-12);
}

// Without noise, an axis that comes late leaves what it would have left in order.
TEST(Heading, LateAxesAreThoseInOrder) {
  config::TrackerConfig config;
  config.heading_noise = config.turn_noise = 0.0;
  Heading in_order = known(0.1, 0.05), late = in_order;
  in_order = predicted(in_order, config, 10.0, 0.1);
  correct(in_order, 0.2, 0.03, 0.2);
  in_order = predicted(in_order, config, 10.0, 0.2);
  correct(in_order, 0.5, 0.04, 0.5);
  late = predicted(late, config, 10.0, 0.3);
  correct(late, 0.5, 0.04, 0.5);
  correct(late, 0.2, 0.03, 0.2, 0.2);
  expect_same(late, in_order);
}

TEST(Heading, AVelocityBeyondItsErrorResolvesTheFront) {
  const auto along_y = [](double speed, double sigma) {
    return linear::Gaussian<2>{{9.0, speed}, linear::Vector<2>(100.0, sigma * sigma).asDiagonal()};
  };
  Heading heading = known(0.5 * std::numbers::pi, 0.05);
  update_front(heading, along_y(4.9, 1.0));
  EXPECT_EQ(heading.front, 0);
  update_front(heading, along_y(-5.1, 1.0));
  EXPECT_EQ(heading.front, -1);
  update_front(heading, along_y(4.9, 1.0));
  EXPECT_EQ(heading.front, -1) << "it is remembered";
  Heading turned = known(-0.4 * std::numbers::pi, 0.05);
  take_front(turned, heading);
  EXPECT_EQ(turned.front, 1) << "the same end, in the other sense";
  update_front(heading, along_y(5.1, 1.0));
  EXPECT_EQ(heading.front, 1);
  Heading unknown = unknown_heading({});
  update_front(unknown, along_y(50.0, 1.0));
  EXPECT_EQ(unknown.front, 0);
}

}  // namespace
}  // namespace ttf::fusion::tracks::body
