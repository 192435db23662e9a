// Along the road: published values, closed forms, and laws against a drive by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "nodes/control/limits.h"
#include "nodes/control/proportional_integral.h"
#include "nodes/control/r157.h"
#include "nodes/control/time_gap.h"
#include "nodes/control/time_to_collision.h"
#include "tests/nodes/control/r157_drivers.h"

namespace ttf::nodes::control {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

TEST(R157, FollowingDistancesAreThoseOfItsImplementation) {
  const double published[][2] = {{0.0, 2.0},           {1.9, 2.0},           {2.0, 2.0},          {2.5, 2.660},
                                 {10.0 / 3.6, 3.056},  {13.0 / 3.6, 4.081},  {20.0 / 3.6, 6.667}, {40.0 / 3.6, 15.556},
                                 {58.0 / 3.6, 25.456}, {60.0 / 3.6, 26.667}, {90.0 / 3.6, 47.500}};
  for (const auto& [speed, distance] : published)
    EXPECT_NEAR(minimum_following_distance(speed), distance, 5.1e-4) << speed;
}

TEST(R157, CompetentDriver) {
  const CompetentDriver driver;
  EXPECT_NEAR(driver.deceleration / driver.rise_s, 12.65, 0.01);
  EXPECT_DOUBLE_EQ(driver.braking().delay_s, 1.15);
  EXPECT_DOUBLE_EQ(deceleration_at(driver.braking(), 1.1), 0.0);
  EXPECT_NEAR(deceleration_at(driver.braking(), 1.45), 0.387 * kGravity, 1e-12);
  EXPECT_DOUBLE_EQ(deceleration_at(driver.braking(), 9.0), 0.774 * kGravity);
}

// The way of Euler's midpoint steps, which use no formula for it.
double driven_to_standstill(const Braking& braking, double speed) {
  constexpr double dt = 1e-4;
  double way = 0.0;
  for (double t = 0.0; speed > 0.0; t += dt) {
    const double slower = speed - dt * deceleration_at(braking, t + 0.5 * dt);
    way += 0.5 * dt * (speed + std::max(slower, 0.0));
    speed = slower;
  }
  return way;
}

TEST(R157, StoppingDistanceIsThatOfADrive) {
  for (const double speed : {0.5, 2.0, 10.0, 29.0})  // at 2 m/s, it stands before the largest deceleration
    for (const Braking& braking : {CompetentDriver{}.braking(), kRegulationBraking})
      EXPECT_NEAR(stopping_distance(braking, speed), driven_to_standstill(braking, speed), 2e-3) << speed;
  EXPECT_DOUBLE_EQ(stopping_distance(kRegulationBraking, 12.0), 0.35 * 12.0 + 12.0);
  EXPECT_DOUBLE_EQ(stopping_distance(kRegulationBraking, 0.0), 0.0);
}

TEST(R157, CutInsToBeSurvived) {
  EXPECT_FALSE(cut_in_must_be_survived(1.35, 12.0));
  EXPECT_TRUE(cut_in_must_be_survived(1.36, 12.0));
}

TEST(Limits, FollowTheSpeedAndTheJerk) {
  const LimitsBySpeed iso;
  EXPECT_DOUBLE_EQ(at_speed(iso, 2.0).deceleration, 5.0);
  EXPECT_DOUBLE_EQ(at_speed(iso, 12.5).deceleration, 4.25);
  EXPECT_DOUBLE_EQ(at_speed(iso, 30.0).deceleration, 3.5);
  EXPECT_DOUBLE_EQ(at_speed(iso, 12.5).jerk, 3.75);
  const Limits fast = at_speed(iso, 30.0);
  EXPECT_DOUBLE_EQ(limited(fast, -9.0, -3.4, 0.1), -3.5);
  EXPECT_DOUBLE_EQ(limited(fast, -9.0, 0.0, 0.1), -0.25);
  EXPECT_DOUBLE_EQ(limited(fast, 9.0, 1.9, 0.1), 2.0);
  EXPECT_DOUBLE_EQ(limited(fast, 9.0, 0.0, 0.1), 0.25);
  EXPECT_DOUBLE_EQ(limited(fast, -9.0, -5.0, 0.1), -4.75) << "the limit has become narrower";
  EXPECT_DOUBLE_EQ(limited({2.0, 3.5, kNever}, -9.0, 2.0, 0.1), -3.5);
}

TEST(TimeGap, IsTheLawAndTheSlowerOfTwo) {
  const TimeGapConfig config{1.5, 2.0, 0.2, 0.7, 0.4};
  EXPECT_DOUBLE_EQ(wanted_clearance(config, 20.0), 32.0);
  EXPECT_DOUBLE_EQ(time_gap_acceleration(config, 20.0, 50.0, Ahead{42.0, 18.0}), 0.2 * 10.0 - 0.7 * 2.0);
  EXPECT_DOUBLE_EQ(time_gap_acceleration(config, 20.0, 25.0, Ahead{500.0, 30.0}), 2.0) << "as fast as it is set";
  EXPECT_DOUBLE_EQ(time_gap_acceleration(config, 20.0, 25.0, std::nullopt), 2.0);
  EXPECT_DOUBLE_EQ(time_gap_acceleration(config, 20.0, 50.0, Ahead{32.0, 20.0}), 0.0);
}

// The error's closed form for real poles, from e = 8 and e' = -h a - v + v_lead.
TEST(TimeGap, ErrorFadesAsItsPolesSay) {
  const TimeGapConfig config;
  const double lead = 15.0;
  double speed = 15.0, clearance = wanted_clearance(config, speed) + 8.0;
  constexpr double dt = 1e-4;
  const double damping = config.time_gap_s * config.gap_gain + config.speed_gain;
  const double root = std::sqrt(damping * damping - 4.0 * config.gap_gain);
  const double slow = (-damping + root) / 2.0, fast = (-damping - root) / 2.0;
  const double rate = -config.time_gap_s * config.gap_gain * 8.0;  // e' at the start
  const double of_fast = (rate - slow * 8.0) / (fast - slow), of_slow = 8.0 - of_fast;
  for (int step = 1; step <= 100000; ++step) {
    const double acceleration = time_gap_acceleration(config, speed, 1e3, Ahead{clearance, lead});
    clearance += dt * (lead - speed) - 0.5 * dt * dt * acceleration;
    speed += dt * acceleration;
    if (step % 20000 == 0) {
      const double t = dt * step;
      EXPECT_NEAR(clearance - wanted_clearance(config, speed),
                  of_slow * std::exp(slow * t) + of_fast * std::exp(fast * t), 1e-3)
          << t;
    }
  }
}

// The largest gain from the speed ahead to the own one, over frequencies. The actuator lags by `lag_s`.
double largest_gain(const TimeGapConfig& config, double lag_s) {
  double largest = 0.0;
  for (double frequency = 1e-3; frequency < 10.0; frequency *= 1.02) {  // [rad/s]
    const std::complex<double> s{0.0, frequency};
    const double damping = config.time_gap_s * config.gap_gain + config.speed_gain;
    const std::complex<double> gain =
        (config.speed_gain * s + config.gap_gain) / (lag_s * s * s * s + s * s + damping * s + config.gap_gain);
    largest = std::max(largest, std::abs(gain));
  }
  return largest;
}

TEST(TimeGap, StringsAreStableAsTheHeaderSays) {
  TimeGapConfig config;
  EXPECT_LE(largest_gain(config, 0.0), 1.0);
  config.time_gap_s = 0.8;
  EXPECT_GT(largest_gain(config, 0.0), 1.01);
  // With a lag of 0.5 s: stable at twice the lag with k2 = 1 / (2 T), and below it with no gains.
  EXPECT_LE(largest_gain({1.0, 2.0, 0.23, 1.0, 0.4}, 0.5), 1.0 + 1e-12);
  for (const double gap_gain : {0.01, 0.1, 0.5, 2.0})
    for (const double speed_gain : {0.1, 0.5, 1.0, 2.0, 5.0})
      EXPECT_GT(largest_gain({0.9, 2.0, gap_gain, speed_gain, 0.4}, 0.5), 1.0) << gap_gain << " " << speed_gain;
}

TEST(ProportionalIntegral, IsLinearBetweenItsLimits) {
  const ProportionalIntegral controller;
  double integral = 0.0;
  for (int step = 0; step < 10; ++step)
    EXPECT_NEAR(controller.step(0.5, 0.01, integral), 2.5 * 0.5 + 0.01 * 0.5 * step, 1e-12);
}

TEST(ProportionalIntegral, DoesNotWindUp) {
  const ProportionalIntegral controller{2.5, 1.0, 0.8, -6.0, 3.0};
  constexpr double dt = 0.01, error = 4.0;
  double integral = 1.0;
  const double rest = 3.0 - 2.5 * error + 1.0 * 0.8 * error;
  for (int step = 1; step <= 500; ++step) {
    EXPECT_EQ(controller.step(error, dt, integral), 3.0);
    EXPECT_NEAR(integral, rest + (1.0 - rest) * std::pow(1.0 - dt / 0.8, step), 1e-10);
  }
  // The error changes its sign: a wound up integral of 1 * 4 * 5 s would keep the output at the limit for long.
  EXPECT_LT(controller.step(-0.5, dt, integral), 0.0);
  EXPECT_EQ(controller.step(-9.0, dt, integral), -6.0);
}

TEST(TimeToCollision, ConstantSpeeds) {
  EXPECT_DOUBLE_EQ(time_to_collision(30.0, 10.0), 3.0);
  EXPECT_EQ(time_to_collision(30.0, 0.0), kNever);
  EXPECT_EQ(time_to_collision(0.0, -1.0), 0.0);
  EXPECT_DOUBLE_EQ(time_to_collision(30.0, {20.0, 0.0}, {10.0, 0.0}), 3.0);
  EXPECT_EQ(time_to_collision(30.0, {10.0, 0.0}, {10.0, 0.0}), kNever);
}

// Steps of 0.1 ms, without a formula.
double touched(double clearance, InLine own, InLine ahead) {
  constexpr double dt = 1e-4;
  const auto drive = [](InLine& vehicle) {
    const double later = std::max(0.0, vehicle.speed + dt * vehicle.acceleration);
    const double way = 0.5 * dt * (vehicle.speed + later);
    vehicle.speed = later;
    return way;
  };
  for (double t = 0.0; t < 60.0; t += dt) {
    if (clearance <= 0.0) return t;
    clearance += drive(ahead) - drive(own);
  }
  return kNever;
}

TEST(TimeToCollision, AcceleratedVehiclesThatStop) {
  const struct {
    double clearance;
    InLine own, ahead;
  } cases[] = {
      {40.0, {29.0, 0.0}, {29.0, -8.0}},   // the vehicle ahead brakes hard
      {40.0, {29.0, -8.0}, {29.0, -8.0}},  // never: both stop alike
      {5.0, {20.0, -6.0}, {18.0, -8.0}},   // the vehicle ahead stands before
      {20.0, {10.0, -2.0}, {5.0, 0.0}},    // never: slow in time
      {10.0, {10.0, -1.0}, {5.0, 0.0}},    // while it brakes
      {10.0, {0.0, 1.0}, {2.0, 0.0}},      // it catches up
      {10.0, {3.0, -1.0}, {0.0, 0.0}},     // never: it stops short
      {10.0, {3.0, -1.0}, {0.0, 2.0}},     // never: the other drives away
      {50.0, {20.0, -1.0}, {30.0, -9.0}},  // the gap grows first
  };
  for (const auto& [clearance, own, ahead] : cases) {
    const double expected = touched(clearance, own, ahead), got = time_to_collision(clearance, own, ahead);
    if (expected == kNever)
      EXPECT_EQ(got, kNever) << clearance;
    else
      EXPECT_NEAR(got, expected, 2e-3) << clearance;
  }
}

}  // namespace
}  // namespace ttf::nodes::control
