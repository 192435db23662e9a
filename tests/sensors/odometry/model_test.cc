// Odometry: its errors by their moments, and draws that depend on the measurement alone.
#include "sensors/odometry/model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ttf::sensors::odometry {
namespace {

const EgoState kTurning{.vx = 10.0, .yaw_rate = 0.3};

TEST(Odometry, WithoutErrorsIsTheTruth) {
  OdometryConfig config;
  config.speed_sigma_mps = config.yaw_rate_sigma_radps = 0.0;
  const OdometrySample sample = measure_odometry(config, kTurning, {1, 0, 0, 5});
  EXPECT_EQ(sample.speed, 10.0);
  EXPECT_EQ(sample.yaw_rate, 0.3);
}

TEST(Odometry, HasItsMoments) {
  OdometryConfig config;
  config.speed_scale.fixed = 0.02;
  config.yaw_rate_bias.fixed = -0.01;
  constexpr int kSamples = 20'000;
  double speed = 0.0, rate = 0.0, speed_squares = 0.0, rate_squares = 0.0, products = 0.0;
  for (std::uint32_t k = 0; k < kSamples; ++k) {
    const OdometrySample sample = measure_odometry(config, kTurning, {3, 1, 2, k});
    const double a = sample.speed - 10.2, b = sample.yaw_rate - 0.29;
    speed += a / kSamples, rate += b / kSamples;
    speed_squares += a * a / kSamples, rate_squares += b * b / kSamples, products += a * b / kSamples;
  }
  const double sigma = config.speed_sigma_mps, turn = config.yaw_rate_sigma_radps, n = std::sqrt(kSamples);
  EXPECT_NEAR(speed, 0.0, 4.0 * sigma / n);
  EXPECT_NEAR(rate, 0.0, 4.0 * turn / n);
  EXPECT_NEAR(speed_squares / (sigma * sigma), 1.0, 6.0 / n);
  EXPECT_NEAR(rate_squares / (turn * turn), 1.0, 6.0 / n);
  EXPECT_NEAR(products / (sigma * turn), 0.0, 4.0 / n);
}

TEST(Odometry, NoiseIsThatOfTheMeasurement) {
  const OdometryConfig config;
  const EgoState faster{.vx = 20.0, .yaw_rate = -0.1};
  const OdometrySample a = measure_odometry(config, kTurning, {1, 0, 2, 9}),
                       b = measure_odometry(config, faster, {1, 0, 2, 9});
  EXPECT_NEAR(a.speed - 10.0, b.speed - 20.0, 1e-12);
  EXPECT_NEAR(a.yaw_rate - 0.3, b.yaw_rate + 0.1, 1e-12);
  EXPECT_NE(a.speed, measure_odometry(config, kTurning, {1, 0, 2, 10}).speed);
  EXPECT_NE(a.speed, measure_odometry(config, kTurning, {1, 0, 3, 9}).speed);
  EXPECT_NE(a.speed, measure_odometry(config, kTurning, {1, 1, 2, 9}).speed);
}

TEST(Odometry, DrawsItsErrorsOnceADrive) {
  OdometryConfig config;
  config.speed_scale.sigma = 0.01;
  config.yaw_rate_bias.sigma = 0.01;
  config.device.time.sigma = 0.001;
  const OdometryConfig one = in_drive(config, {1, 0, 2}), again = in_drive(config, {1, 0, 2}),
                       other = in_drive(config, {1, 1, 2});
  EXPECT_EQ(one.speed_scale.fixed, again.speed_scale.fixed);
  EXPECT_NE(one.speed_scale.fixed, other.speed_scale.fixed);
  EXPECT_NE(one.speed_scale.fixed, one.yaw_rate_bias.fixed);
  EXPECT_NE(one.device.time.fixed, 0.0);
  EXPECT_EQ(one.speed_scale.sigma, 0.0);
}

}  // namespace
}  // namespace ttf::sensors::odometry
