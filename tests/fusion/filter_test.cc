// The filter against closed forms, a batch solution in information form, and numerical differentiation.
#include "fusion/filter.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/fusion/scenes.h"

namespace ttf::fusion {
namespace {

const MotionModel kModels[] = {MotionModel::kConstantVelocity, MotionModel::kConstantAcceleration};

TEST(Predict, MatchesTheIntegratedNoise) {
  RandomStream stream({.seed = 1});
  for (const MotionModel motion : kModels)
    for (const double dt : {0.0, 0.001, 0.01, 0.7, 3.0}) {
      Eigen::Matrix<double, 6, 6> root;
      for (int i = 0; i < 36; ++i) root.data()[i] = stream.normal();
      Estimate estimate;
      estimate.p = root * root.transpose();
      for (int i = 0; i < 6; ++i) estimate.x(i) = stream.normal();
      const Covariance f = transition(motion, dt);
      const State x = f * estimate.x;
      const Covariance p = f * estimate.p * f.transpose() + driving_noise(motion, 2.5, dt);
      predict(estimate, motion, 2.5, dt);
      EXPECT_LT((estimate.x - x).norm(), 1e-12 * (1.0 + x.norm()));
      EXPECT_LT((estimate.p - p).norm(), 1e-12 * (1.0 + p.norm()));
      EXPECT_EQ(estimate.p, estimate.p.transpose().eval());
    }
}

TEST(Predict, TwoStepsAreOne) {
  for (const MotionModel motion : kModels) {
    Estimate once, twice;
    once.p = twice.p = Covariance::Identity();
    predict(once, motion, 3.0, 0.5);
    predict(twice, motion, 3.0, 0.2);
    predict(twice, motion, 3.0, 0.3);
    EXPECT_LT((once.p - twice.p).norm(), 1e-13);
  }
}

// Steady state of the continuous Riccati equation A P + P A' + G q G' - P H' H P / rho = 0 in closed form,
// for two and three integrators in a row. With measurements every dt of variance rho / dt, the discrete
// filter's mean of prior and posterior comes to it as dt goes to 0.
TEST(Kalman, ReachesTheSteadyStateOfTheRiccatiEquation) {
  constexpr double q = 3.0, rho = 0.02, dt = 1e-3;
  for (const MotionModel motion : kModels) {
    Estimate posterior, prior;
    posterior.p = Covariance::Identity();
    if (motion == MotionModel::kConstantVelocity) posterior.p(4, 4) = posterior.p(5, 5) = 0.0;
    const Observation z = position(0.0, 0.0, std::sqrt(rho / dt));
    for (int i = 0; i < 10'000; ++i) {
      predict(posterior, motion, q, dt);
      prior = posterior;
      update(posterior, z, innovate(posterior, z));
    }
    const Covariance p = 0.5 * (prior.p + posterior.p);
    if (motion == MotionModel::kConstantVelocity) {
      EXPECT_NEAR(p(0, 0) / (std::sqrt(2.0) * std::pow(q, 0.25) * std::pow(rho, 0.75)), 1.0, 1e-4);
      EXPECT_NEAR(p(0, 2) / std::sqrt(q * rho), 1.0, 1e-4);
      EXPECT_NEAR(p(2, 2) / (std::sqrt(2.0) * std::pow(q, 0.75) * std::pow(rho, 0.25)), 1.0, 1e-4);
      EXPECT_EQ(p(4, 4), 0.0);
    } else {
      const double sixth = std::pow(q, 1.0 / 6.0), root = std::pow(rho, 1.0 / 6.0);
      EXPECT_NEAR(p(0, 0) / (2.0 * sixth * std::pow(root, 5)), 1.0, 1e-4);
      EXPECT_NEAR(p(0, 2) / (2.0 * std::pow(sixth, 2) * std::pow(root, 4)), 1.0, 1e-4);
      EXPECT_NEAR(p(0, 4) / std::sqrt(q * rho), 1.0, 1e-4);
      EXPECT_NEAR(p(2, 2) / (3.0 * std::sqrt(q * rho)), 1.0, 1e-4);
      EXPECT_NEAR(p(2, 4) / (2.0 * std::pow(sixth, 4) * std::pow(root, 2)), 1.0, 1e-4);
      EXPECT_NEAR(p(4, 4) / (2.0 * std::pow(sixth, 5) * root), 1.0, 1e-4);
    }
    EXPECT_LT(std::abs(p(0, 1)) + std::abs(p(2, 3)), 1e-15) << "the axes stay apart";
    EXPECT_NEAR(p(1, 1), p(0, 0), 1e-15);
  }
}

// All states x_0 .. x_n of a run are the least-squares solution of one linear system: the prior of x_0, the
// transitions weighed with Q^-1 and the measurements with R^-1. The last state and its covariance are what
// the filter must have.
TEST(Kalman, EqualsBatchLeastSquares) {
  for (const MotionModel motion : kModels) {
    const int per_axis = motion == MotionModel::kConstantVelocity ? 2 : 3, n = 2 * per_axis, steps = 9;
    RandomStream stream({.seed = 3});
    Estimate estimate;
    for (int i = 0; i < n; ++i) {
      estimate.x(i) = stream.normal();
      estimate.p(i, i) = 1.0 + stream.uniform();
    }
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero((steps + 1) * n, (steps + 1) * n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero((steps + 1) * n);
    information.topLeftCorner(n, n) = estimate.p.topLeftCorner(n, n).inverse();
    right.head(n) = information.topLeftCorner(n, n) * estimate.x.head(n);
    for (int k = 1; k <= steps; ++k) {
      const double dt = 0.2 + 0.3 * stream.uniform();
      const Eigen::MatrixXd f = transition(motion, dt).topLeftCorner(n, n);
      const Eigen::MatrixXd weight = driving_noise(motion, 2.0, dt).topLeftCorner(n, n).inverse();
      information.block((k - 1) * n, (k - 1) * n, n, n) += f.transpose() * weight * f;
      information.block((k - 1) * n, k * n, n, n) -= f.transpose() * weight;
      information.block(k * n, (k - 1) * n, n, n) -= weight * f;
      information.block(k * n, k * n, n, n) += weight;
      Observation z = position(stream.normal(), stream.normal(), 0.4);
      z.r(0, 1) = z.r(1, 0) = 0.05;
      const Eigen::MatrixXd r_inverse = Eigen::MatrixXd(z.r.topLeftCorner<2, 2>()).inverse();
      const Eigen::VectorXd measured = z.z.head<2>();
      information.block(k * n, k * n, 2, 2) += r_inverse;
      right.segment(k * n, 2) += r_inverse * measured;
      predict(estimate, motion, 2.0, dt);
      update(estimate, z, innovate(estimate, z));
    }
    const Eigen::VectorXd solution = information.ldlt().solve(right);
    const Eigen::MatrixXd covariance = information.inverse().bottomRightCorner(n, n);
    EXPECT_LT((estimate.x.head(n) - solution.tail(n)).norm(), 1e-8);
    EXPECT_LT((estimate.p.topLeftCorner(n, n) - covariance).norm(), 1e-8 * covariance.norm());
  }
}

TEST(Kalman, CovarianceStaysSymmetricAndPositive) {
  // Measurements a million times better than the prior, at intervals from nothing to seconds.
  RandomStream stream({.seed = 4});
  Estimate estimate = initial_estimate(position(5.0, 5.0, 100.0), TrackerConfig{});
  for (int i = 0; i < 2000; ++i) {
    predict(estimate, MotionModel::kConstantVelocity, 3.0,
            i % 7 == 0 ? 0.0 : std::pow(10.0, stream.uniform(-5.0, 0.5)));
    const Observation z = i % 2 ? position(5.0 + 1e-4 * stream.normal(), 5.0, 1e-4)
                                : radar(7.07, kPi / 4.0, 0.0, 1e-3, 1e-4, 1e-3);
    update(estimate, z, innovate(estimate, z));
    ASSERT_EQ(estimate.p, estimate.p.transpose().eval());
    const Eigen::Matrix4d p = estimate.p.topLeftCorner<4, 4>();
    ASSERT_GT(p.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0) << i;
  }
}

TEST(Radar, JacobianIsTheDerivative) {
  RandomStream stream({.seed = 5});
  for (int draw_index = 0; draw_index < 300; ++draw_index) {
    State x;
    const double range = stream.uniform(0.5, 80.0), bearing = stream.uniform(-3.0, 3.0);
    x << range * std::cos(bearing), range * std::sin(bearing), 20.0 * stream.normal(), 20.0 * stream.normal(),
        stream.normal(), stream.normal();
    const Eigen::Matrix<double, 3, 6> h = jacobian(ObservationKind::kRangeBearingRate, x);
    for (int i = 0; i < 6; ++i) {
      const double step = 1e-5;
      State up = x, down = x;
      up(i) += step;
      down(i) -= step;
      const Eigen::Vector3d slope = (expected(ObservationKind::kRangeBearingRate, up) -
                                     expected(ObservationKind::kRangeBearingRate, down)) /
                                    (2.0 * step);
      for (int row = 0; row < 3; ++row)
        ASSERT_NEAR(h(row, i), slope(row), 1e-6 * (1.0 + std::abs(slope(row))))
            << "d " << row << " / d " << i;
    }
  }
}

TEST(Radar, BearingIsWrappedBehindTheSensor) {
  // Expected just above +pi, measured just below -pi: 0.02 rad apart, not 2 pi.
  Estimate estimate;
  estimate.x << 10.0 * std::cos(kPi - 0.01), 10.0 * std::sin(kPi - 0.01), 0.0, 0.0, 0.0, 0.0;
  estimate.p.diagonal() << 1.0, 1.0, 1.0, 1.0, 0.0, 0.0;
  const Observation z = radar(10.0, -kPi + 0.01, 0.0, 0.3, 0.03, 0.3);
  const Innovation innovation = innovate(estimate, z);
  ASSERT_TRUE(innovation.valid);
  EXPECT_NEAR(innovation.nu(1), 0.02, 1e-12);
  update(estimate, z, innovation);
  EXPECT_LT(estimate.x(1), 0.1) << "moved across the axis, the short way";
  EXPECT_NEAR(estimate.x(0), -10.0, 0.1);
}

TEST(Radar, NothingIsLearntAtTheOrigin) {
  Estimate estimate;
  estimate.p = Covariance::Identity();
  EXPECT_FALSE(innovate(estimate, radar(0.1, 0.0, 0.0, 0.3, 0.03, 0.3)).valid);
}

TEST(WrapAngle, IntoTheHalfOpenCircle) {
  EXPECT_EQ(wrap_angle(0.5), 0.5);
  EXPECT_NEAR(wrap_angle(0.5 + 40.0 * kPi), 0.5, 1e-12);
  EXPECT_NEAR(wrap_angle(kPi + 0.1), -kPi + 0.1, 1e-12);
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
}

TEST(InitialEstimate, RadarKnowsTheVelocityAlongItsBeam) {
  TrackerConfig config;
  const double bearing = 0.6;
  const Estimate estimate = initial_estimate(radar(20.0, bearing, -4.0, 0.3, 0.03, 0.2), config);
  const Eigen::Vector2d along(std::cos(bearing), std::sin(bearing)), across(-along(1), along(0));
  EXPECT_LT((estimate.x.head<2>() - 20.0 * along).norm(), 1e-12);
  EXPECT_LT((estimate.x.segment<2>(2) + 4.0 * along).norm(), 1e-12);
  const Eigen::Matrix2d position_p = estimate.p.topLeftCorner<2, 2>(),
                        velocity_p = estimate.p.block<2, 2>(2, 2);
  EXPECT_NEAR(along.dot(position_p * along), 0.3 * 0.3, 1e-12);
  EXPECT_NEAR(across.dot(position_p * across), 20.0 * 20.0 * 0.03 * 0.03, 1e-12);
  EXPECT_NEAR(along.dot(velocity_p * along), 0.2 * 0.2, 1e-12);
  EXPECT_NEAR(across.dot(velocity_p * across), config.initial_velocity_sigma * config.initial_velocity_sigma,
              1e-9);
  EXPECT_EQ(estimate.p(4, 4), 0.0) << "constant velocity: acceleration is zero and certain";
  // The measurement itself is the best explanation of the new state.
  EXPECT_LT(innovate(estimate, radar(20.0, bearing, -4.0, 0.3, 0.03, 0.2)).nu.norm(), 1e-12);
}

TEST(InitialEstimate, PositionAloneLeavesVelocityOpen) {
  TrackerConfig config;
  config.motion = MotionModel::kConstantAcceleration;
  const Estimate estimate = initial_estimate(position(3.0, -2.0, 0.25), config);
  State variances;
  variances << 0.0625, 0.0625, 64.0, 64.0, 4.0, 4.0;
  EXPECT_EQ(estimate.p, Covariance(variances.asDiagonal()));
  EXPECT_EQ(estimate.x(0), 3.0);
  EXPECT_EQ(estimate.x(2), 0.0);
}

}  // namespace
}  // namespace ttf::fusion
