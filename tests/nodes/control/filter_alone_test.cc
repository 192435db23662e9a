// The share of a filter in the time until a braking car is seen to brake: a filter by itself, without detector, tracker
// and bus (docs/fusion/adaptive_detection.md has the table, and docs/results/adaptive_detection_causes.md that of a whole
// loop).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace ttf::nodes::control {
namespace {

struct Case {
  double interval_s;
  double assumed_sigma_m, true_sigma_m;
  double density = 0.0;   // [m^2/s^3]; 0: 1 m/s^2 of standard deviation, drawn anew each interval
  double detected = 1.0;  // share of the intervals with a measurement
};

// Position and velocity of a car that drives with 29 m/s and brakes with 8 m/s^2 from 0 s on. A result is known 50 ms
// after its measurement. Returns the time from 27 m/s in truth until the velocity says so.
double reaction(const Case& c, RandomStream& draws) {
  constexpr double kBraking = 8.0, kSpeed = 29.0, kBelow = 27.0, kAge_s = 0.05;
  const double r = c.assumed_sigma_m * c.assumed_sigma_m, dt = c.interval_s;
  const double q11 = c.density > 0.0 ? c.density * dt : dt * dt;
  const double q01 = 0.5 * q11 * dt, q00 = q11 * dt * dt / (c.density > 0.0 ? 3.0 : 4.0);
  double x = 0.0, v = kSpeed, p00 = r, p01 = 0.0, p11 = 100.0;
  double t = -8.0 + dt * draws.uniform();
  x = kSpeed * t;
  for (;; t += dt) {
    const double braked = std::min(std::max(t, 0.0), kSpeed / kBraking);
    const double z =
        kSpeed * std::min(t, kSpeed / kBraking) - 0.5 * kBraking * braked * braked + c.true_sigma_m * draws.normal();
    x += dt * v;
    p00 += 2.0 * dt * p01 + dt * dt * p11 + q00;
    p01 += dt * p11 + q01;
    p11 += q11;
    if (c.detected >= 1.0 || draws.uniform() < c.detected) {
      const double gain_x = p00 / (p00 + r), gain_v = p01 / (p00 + r), error = z - x;
      x += gain_x * error;
      v += gain_v * error;
      p11 -= gain_v * p01;
      p00 *= 1.0 - gain_x;
      p01 *= 1.0 - gain_x;
    }
    const double since = t + kAge_s - (kSpeed - kBelow) / kBraking;
    if (since >= 0.0 && v < kBelow) return since;
  }
}

double mean_reaction(const Case& c) {
  RandomStream draws({1, 0, Purpose::kSensorNoise, 0, 0});
  double sum = 0.0;
  for (int i = 0; i < 300; ++i) sum += reaction(c, draws);
  return sum / 300.0;
}

// Noise that is drawn anew each interval makes a filter as slow at any interval.
TEST(FilterAlone, ReactsLateWhateverTheIntervalWithNoiseByTheStep) {
  for (const double interval : {0.154, 0.061, 0.042}) EXPECT_NEAR(mean_reaction({interval, 1.0, 1.0}), 1.15, 0.03);
}

TEST(FilterAlone, ReactsSoonerToShorterIntervalsWithNoiseByTheTime) {
  const double expected[3] = {1.48, 1.27, 1.18}, intervals[3] = {0.154, 0.061, 0.042};
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(mean_reaction({intervals[i], 2.1, 2.1, 0.154}), expected[i], 0.04);
  const double sharper[3] = {1.05, 0.90, 0.85};
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(mean_reaction({intervals[i], 2.1, 2.1, 1.0}), sharper[i], 0.04);
}

TEST(FilterAlone, ReactsSoonestToARadar) { EXPECT_NEAR(mean_reaction({0.1, 0.45, 0.45, 0.154}), 0.80, 0.04); }

// The intervals of a whole loop, with a bound of 0 and of 300 ms.
TEST(FilterAlone, ReactsAsTheWholeLoopDoes) {
  struct {
    double assumed_sigma_m, true_sigma_m, density, detected, expected[2];
  } const cases[] = {
      {2.1, 2.1, 0.154, 1.0, {1.49, 1.23}}, {1.0, 2.1, 0.0, 1.0, {1.13, 1.14}}, {2.1, 2.1, 1.0, 1.0, {1.07, 0.87}},
      {2.1, 0.0, 0.154, 1.0, {1.50, 1.24}}, {1.0, 0.0, 0.0, 1.0, {1.15, 1.15}}, {2.1, 0.0, 1.0, 1.0, {1.08, 0.89}},
      {2.1, 2.1, 0.154, 0.5, {1.75, 1.41}}, {1.0, 2.1, 0.0, 0.5, {1.33, 1.33}}, {2.1, 2.1, 1.0, 0.5, {1.25, 1.00}},
  };
  constexpr double kIntervals[] = {0.154, 0.053};
  for (const auto& c : cases)
    for (int i = 0; i < 2; ++i)
      EXPECT_NEAR(mean_reaction({kIntervals[i], c.assumed_sigma_m, c.true_sigma_m, c.density, c.detected}),
                  c.expected[i], 0.06)
          << c.assumed_sigma_m << " " << c.true_sigma_m << " " << c.density << " " << c.detected << " " << i;
}

}  // namespace
}  // namespace ttf::nodes::control
