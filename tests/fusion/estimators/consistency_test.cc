// The estimator's covariance matches its errors. NEES and NIS lie in their 95 % bands on fixed seeds, and
// outside where the model is wrong (Bar-Shalom, Li, Kirubarajan 2001, section 5.4).
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "fusion/estimators/estimator.h"
#include "fusion/metrics/chi_square.h"
#include "fusion/sensors/range_bearing_rate.h"
#include "tests/fusion/dense.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::estimators {
namespace {

struct Statistics {
  double nees = 0.0, nis = 0.0;                  // means over the runs
  double nees_degrees = 0.0, nis_degrees = 0.0;  // the sums'
  int runs = 0;
  double low(double degrees) const { return metrics::chi_square_quantile(0.025, degrees) / runs; }
  double high(double degrees) const { return metrics::chi_square_quantile(0.975, degrees) / runs; }
};

struct Case {
  config::MotionModel motion = config::MotionModel::kConstantVelocity;
  double true_noise = 3.0, assumed_noise = 3.0;
  double true_sigma = 0.3, assumed_sigma = 0.3;
  bool with_radar = false;
};

// Independent drives, each judged once, at its last step: the sum is then exactly chi-square distributed.
Statistics simulate(const Case& c, int runs, std::uint64_t seed) {
  Statistics s;
  s.runs = runs;
  const int n = c.motion == config::MotionModel::kConstantVelocity ? 4 : 6;
  const double dt = 0.05;
  const auto estimator = make_estimator(config_of(c.motion, c.assumed_noise));
  for (int run = 0; run < runs; ++run) {
    RandomStream stream({.seed = seed, .replication = static_cast<std::uint32_t>(run)});
    Cartesian start;
    start.x << 40.0, 10.0, -2.0, 1.0, 0.0, 0.0;
    start.p.diagonal() << 0.25, 0.25, 4.0, 4.0, 1.0, 1.0;
    if (n == 4) start.p(4, 4) = start.p(5, 5) = 0.0;
    State truth = draw(start.x, start.p, stream);
    Estimate estimate = estimate_of(c.motion, start.x, start.p);
    for (int k = 1; k <= 40; ++k) {
      truth = draw(transition(c.motion, dt) * truth, driving_noise(c.motion, c.true_noise, dt), stream);
      estimator->predict(estimate, dt);
      sensors::Observation z;
      if (c.with_radar && k % 2 == 0) {
        z = radar(0, 0, 0, 0.3, 0.01, 0.2);
        z.z = sensors::RangeBearingRate{}.expected({.position = truth.head<2>(), .velocity = truth.segment<2>(2)});
        for (int i = 0; i < 3; ++i) z.z(i) += std::sqrt(z.r(i, i)) * stream.normal();
      } else {
        z = position(truth(0) + c.true_sigma * stream.normal(), truth(1) + c.true_sigma * stream.normal(),
                     c.assumed_sigma);
      }
      if (k == 40) {
        s.nis += estimator->distance_squared(estimate, z).value() / runs;
        s.nis_degrees += dimension_of(z.kind);
      }
      estimator->update(estimate, z);
    }
    const Cartesian end = seen_as(estimate);
    const Eigen::VectorXd error = (truth - end.x).head(n);
    s.nees += norm_squared(error, end.p.topLeftCorner(n, n)) / runs;
    s.nees_degrees += n;
  }
  return s;
}

void expect_consistent(const Case& c, std::uint64_t seed) {
  // 5000 runs: bands of +-4 % and less. (With 40000 runs, bands of +-1.5 %, all six statistics lie inside,
  // too.)
  const Statistics s = simulate(c, 5000, seed);
  EXPECT_GT(s.nees, s.low(s.nees_degrees));
  EXPECT_LT(s.nees, s.high(s.nees_degrees));
  EXPECT_GT(s.nis, s.low(s.nis_degrees));
  EXPECT_LT(s.nis, s.high(s.nis_degrees));
}

TEST(Consistency, ConstantVelocity) { expect_consistent({}, 1); }
TEST(Consistency, ConstantAcceleration) {
  expect_consistent({.motion = config::MotionModel::kConstantAcceleration, .true_noise = 2.0, .assumed_noise = 2.0}, 1);
}
// Far enough away for linearisation.
TEST(Consistency, LaserAndRadarInTurn) { expect_consistent({.with_radar = true}, 1); }

TEST(Consistency, TooLittleProcessNoiseShows) {
  const Statistics s = simulate({.true_noise = 3.0, .assumed_noise = 0.3}, 500, 1);
  EXPECT_GT(s.nees, s.high(s.nees_degrees));
  EXPECT_GT(s.nis, s.high(s.nis_degrees));
}
TEST(Consistency, TooMuchProcessNoiseShows) {
  const Statistics s = simulate({.true_noise = 0.3, .assumed_noise = 3.0}, 500, 1);
  EXPECT_LT(s.nees, s.low(s.nees_degrees));
  EXPECT_LT(s.nis, s.low(s.nis_degrees));
}
TEST(Consistency, WrongMeasurementNoiseShows) {
  const Statistics low = simulate({.assumed_sigma = 0.15}, 500, 1), high = simulate({.assumed_sigma = 0.6}, 500, 1);
  EXPECT_GT(low.nees, low.high(low.nees_degrees));
  EXPECT_LT(high.nees, high.low(high.nees_degrees));
}

}  // namespace
}  // namespace ttf::fusion::estimators
