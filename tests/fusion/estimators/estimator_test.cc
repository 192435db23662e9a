// Estimators of straight motion against closed forms and a batch solution in information form. All estimators
// against their laws (fusion/estimators/estimator.h).
#include "fusion/estimators/estimator.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

#include "tests/fusion/choices.h"
#include "tests/fusion/dense.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::estimators {
namespace {

const config::MotionModel kStraight[] = {config::MotionModel::kConstantVelocity,
                                         config::MotionModel::kConstantAcceleration};

// A constant-velocity estimate has a zero, certain acceleration.
Cartesian without_acceleration(Cartesian c) {
  c.x.tail<2>().setZero();
  c.p.rightCols<2>().setZero();
  c.p.bottomRows<2>().setZero();
  return c;
}

TEST(Predict, MatchesTheIntegratedNoise) {
  RandomStream stream({.seed = 1});
  for (const config::MotionModel motion : kStraight)
    for (const double dt : {0.0, 0.001, 0.01, 0.7, 3.0}) {
      Eigen::Matrix<double, 6, 6> root;
      for (int i = 0; i < 36; ++i) root.data()[i] = stream.normal();
      Cartesian start;
      start.p = root * root.transpose();
      for (int i = 0; i < 6; ++i) start.x(i) = stream.normal();
      if (motion == config::MotionModel::kConstantVelocity) start = without_acceleration(start);
      const Dense f = transition(motion, dt), x = f * Dense(start.x);
      const Dense p = f * Dense(start.p) * f.transpose() + Dense(driving_noise(motion, 2.5, dt));
      const auto estimator = make_estimator(config_of(motion, 2.5));
      Estimate estimate = estimate_of(motion, start.x, start.p);
      estimator->predict(estimate, dt);
      const Cartesian moved = estimator->cartesian(estimate);
      EXPECT_LT((Dense(moved.x) - x).norm(), 1e-12 * (1.0 + x.norm()));
      EXPECT_LT((Dense(moved.p) - p).norm(), 1e-12 * (1.0 + p.norm()));
      EXPECT_EQ(moved.p, moved.p.transpose().eval());
    }
}

TEST(Predict, TwoStepsAreOne) {
  for (const config::MotionModel motion : kStraight) {
    const auto estimator = make_estimator(config_of(motion));
    Estimate once = estimate_of(motion, State::Zero(), Covariance::Identity()), twice = once;
    estimator->predict(once, 0.5);
    estimator->predict(twice, 0.2);
    estimator->predict(twice, 0.3);
    EXPECT_LT((seen_as(once).p - seen_as(twice).p).norm(), 1e-13);
  }
}

// The continuous Riccati equation A P + P A' + G q G' - P H' H P / rho = 0 has a steady state in closed form,
// for two and three integrators in a row. With measurements every dt of variance rho / dt, the discrete
// filter's mean of prior and posterior converges to it as dt goes to 0.
TEST(Kalman, ReachesTheSteadyStateOfTheRiccatiEquation) {
  constexpr double q = 3.0, rho = 0.02, dt = 1e-3;
  for (const config::MotionModel motion : kStraight) {
    const auto estimator = make_estimator(config_of(motion, q));
    Estimate posterior = estimate_of(motion, State::Zero(), Covariance::Identity()), prior;
    const sensors::Observation z = position(0.0, 0.0, std::sqrt(rho / dt));
    for (int i = 0; i < 10'000; ++i) {
      estimator->predict(posterior, dt);
      prior = posterior;
      estimator->update(posterior, z);
    }
    const Covariance p = 0.5 * (seen_as(prior).p + seen_as(posterior).p);
    if (motion == config::MotionModel::kConstantVelocity) {
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

// All states x_0 .. x_n of a run are the least-squares solution of one linear system. It contains the prior
// of x_0, the transitions weighed with Q^-1 and the measurements with R^-1. The filter must give the last
// state and its covariance.
TEST(Kalman, EqualsBatchLeastSquares) {
  for (const config::MotionModel motion : kStraight) {
    const int per_axis = motion == config::MotionModel::kConstantVelocity ? 2 : 3, n = 2 * per_axis, steps = 9;
    RandomStream stream({.seed = 3});
    Cartesian start;
    for (int i = 0; i < n; ++i) {
      start.x(i) = stream.normal();
      start.p(i, i) = 1.0 + stream.uniform();
    }
    const auto estimator = make_estimator(config_of(motion, 2.0));
    Estimate estimate = estimate_of(motion, start.x, start.p);
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero((steps + 1) * n, (steps + 1) * n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero((steps + 1) * n);
    information.topLeftCorner(n, n) = inverse(start.p.topLeftCorner(n, n));
    right.head(n) = Dense(information.topLeftCorner(n, n)) * Dense(start.x.head(n));
    for (int k = 1; k <= steps; ++k) {
      const double dt = 0.2 + 0.3 * stream.uniform();
      const Dense f = transition(motion, dt).topLeftCorner(n, n);
      const Dense weight = inverse(driving_noise(motion, 2.0, dt).topLeftCorner(n, n));
      information.block((k - 1) * n, (k - 1) * n, n, n) += f.transpose() * weight * f;
      information.block((k - 1) * n, k * n, n, n) -= f.transpose() * weight;
      information.block(k * n, (k - 1) * n, n, n) -= weight * f;
      information.block(k * n, k * n, n, n) += weight;
      sensors::Observation z = position(stream.normal(), stream.normal(), 0.4);
      z.r(0, 1) = z.r(1, 0) = 0.05;
      const Dense r_inverse = inverse(z.r.topLeftCorner<2, 2>());
      const Dense measured = z.z.head<2>();
      information.block(k * n, k * n, 2, 2) += r_inverse;
      right.segment(k * n, 2) += r_inverse * measured;
      estimator->predict(estimate, dt);
      estimator->update(estimate, z);
    }
    const Eigen::VectorXd solution = solve(information, right);
    const Eigen::MatrixXd covariance = inverse(information).bottomRightCorner(n, n);
    EXPECT_LT((seen_as(estimate).x.head(n) - solution.tail(n)).norm(), 1e-8);
    EXPECT_LT((seen_as(estimate).p.topLeftCorner(n, n) - covariance).norm(), 1e-8 * covariance.norm());
  }
}

TEST(Kalman, CovarianceStaysSymmetricAndPositive) {
  // Measurements a million times better than the prior, at intervals from zero to seconds.
  RandomStream stream({.seed = 4});
  const auto estimator = make_estimator({});
  Estimate estimate = estimator->initial(position(5.0, 5.0, 100.0));
  for (int i = 0; i < 2000; ++i) {
    estimator->predict(estimate, i % 7 == 0 ? 0.0 : std::pow(10.0, stream.uniform(-5.0, 0.5)));
    estimator->update(estimate, i % 2 ? position(5.0 + 1e-4 * stream.normal(), 5.0, 1e-4)
                                      : radar(7.07, kPi / 4.0, 0.0, 1e-3, 1e-4, 1e-3));
    const linear::Matrix<4> p = seen_as(estimate).p.topLeftCorner<4, 4>();
    ASSERT_EQ(p, p.transpose().eval());
    ASSERT_GT(least_eigenvalue(p), 0.0) << i;
  }
}

TEST(Radar, BearingIsWrappedBehindTheSensor) {
  // Expected just above +pi, measured just below -pi: 0.02 rad apart, not 2 pi.
  const auto estimator = make_estimator({});
  const linear::Vector<4> x(10.0 * std::cos(kPi - 0.01), 10.0 * std::sin(kPi - 0.01), 0.0, 0.0);
  Estimate estimate = linear::Gaussian<4>{x, linear::Matrix<4>::Identity()};
  const sensors::Observation z = radar(10.0, -kPi + 0.01, 0.0, 0.3, 0.03, 0.3);
  EXPECT_NEAR(estimator->distance_squared(estimate, z).value(), 0.02 * 0.02 / (0.01 + 0.03 * 0.03), 1e-6);
  estimator->update(estimate, z);
  EXPECT_LT(seen_as(estimate).x(1), 0.1) << "moved across the axis, the short way";
  EXPECT_NEAR(seen_as(estimate).x(0), -10.0, 0.1);
}

TEST(InitialEstimate, RadarGivesTheVelocityAlongItsBeam) {
  config::TrackerConfig config;
  const double bearing = 0.6;
  const Cartesian estimate = seen_as(make_estimator(config)->initial(radar(20.0, bearing, -4.0, 0.3, 0.03, 0.2)));
  const Eigen::Vector2d along(std::cos(bearing), std::sin(bearing)), across(-along(1), along(0));
  EXPECT_LT((estimate.x.head<2>() - 20.0 * along).norm(), 1e-12);
  EXPECT_LT((estimate.x.segment<2>(2) + 4.0 * along).norm(), 1e-12);
  const Eigen::Matrix2d position_p = estimate.p.topLeftCorner<2, 2>(), velocity_p = estimate.p.block<2, 2>(2, 2);
  EXPECT_NEAR(along.dot(position_p * along), 0.3 * 0.3, 1e-12);
  EXPECT_NEAR(across.dot(position_p * across), 20.0 * 20.0 * 0.03 * 0.03, 1e-12);
  EXPECT_NEAR(along.dot(velocity_p * along), 0.2 * 0.2, 1e-12);
  EXPECT_NEAR(across.dot(velocity_p * across), config.initial_velocity_sigma * config.initial_velocity_sigma, 1e-9);
}

TEST(InitialEstimate, PositionAloneLeavesVelocityOpen) {
  const auto estimator = make_estimator(config_of(config::MotionModel::kConstantAcceleration));
  const Cartesian estimate = estimator->cartesian(estimator->initial(position(3.0, -2.0, 0.25)));
  State variances;
  variances << 0.0625, 0.0625, 64.0, 64.0, 4.0, 4.0;
  EXPECT_EQ(estimate.p, Covariance(variances.asDiagonal()));
  EXPECT_EQ(estimate.x(0), 3.0);
  EXPECT_EQ(estimate.x(2), 0.0);
}

// The laws, and how an object that turns starts.
class EveryEstimator : public testing::TestWithParam<Choice> {
 protected:
  const config::TrackerConfig config = config_of(std::get<0>(GetParam()), 1.0, std::get<1>(GetParam()));
  const std::shared_ptr<const Estimator> estimator = make_estimator(config);
  bool needs_course() const {
    return config.motion != config::MotionModel::kConstantVelocity &&
           config.motion != config::MotionModel::kConstantAcceleration;
  }
  void expect_lawful(const Estimate& estimate, int step) const {
    const Cartesian all = estimator->cartesian(estimate);
    EXPECT_EQ(estimator->velocity(estimate), (all.x.segment<2>(2)));
    const linear::Gaussian<2> position = estimator->position(estimate);
    ASSERT_TRUE(all.x.allFinite() && all.p.allFinite()) << step;
    ASSERT_EQ(all.p, all.p.transpose().eval()) << step;
    ASSERT_GT(least_eigenvalue(all.p), -1e-9 * all.p.trace()) << step;
    ASSERT_EQ(position.x, all.x.head<2>().eval()) << step;
    ASSERT_EQ(position.p, (all.p.topLeftCorner<2, 2>().eval())) << step;
  }
};
INSTANTIATE_TEST_SUITE_P(All, EveryEstimator, every_choice(), name_of_choice);

// Laws 1, 2 and 4 along a drive. A car stands, drives off, turns, is hidden for two seconds and stops.
// Positions and a radar's measurements alternate.
TEST_P(EveryEstimator, KeepsItsLaws) {
  RandomStream stream({.seed = 6});
  linear::Vector<2> at(30.0, -8.0);
  Estimate estimate = estimator->initial(position(at(0), at(1), 0.3));
  double heading = 2.5, speed = 0.0;
  for (int k = 1; k <= 600; ++k) {
    speed = k < 100 ? 0.0 : k < 500 ? std::min(10.0, speed + 0.2) : std::max(0.0, speed - 0.3);
    if (k >= 200 && k < 320) heading += 0.02;
    const linear::Vector<2> velocity = speed * linear::Vector<2>(std::cos(heading), std::sin(heading));
    at += 0.05 * velocity;
    const Estimate kept = estimate;
    Estimate unmoved = estimate;
    estimator->predict(unmoved, 0.0);
    ASSERT_TRUE(same_bits(unmoved, kept)) << k;
    estimator->predict(estimate, 0.05);
    expect_lawful(estimate, k);
    if (k >= 400 && k < 440) continue;
    const double range = at.norm();
    const sensors::Observation z =
        k % 2 ? position(at(0) + 0.2 * stream.normal(), at(1) + 0.2 * stream.normal(), 0.2)
              : radar(range + 0.3 * stream.normal(), std::atan2(at(1), at(0)) + 0.02 * stream.normal(),
                      at.dot(velocity) / range + 0.3 * stream.normal(), 0.3, 0.02, 0.3);
    const std::optional<double> distance_squared = estimator->distance_squared(estimate, z);
    ASSERT_TRUE(!distance_squared || *distance_squared >= 0.0) << k;
    estimator->update(estimate, z);
    expect_lawful(estimate, k);
    Estimate again = kept;
    estimator->predict(again, 0.05);
    estimator->update(again, z);
    ASSERT_TRUE(same_bits(again, estimate)) << k;
  }
  const Cartesian end = estimator->cartesian(estimate);
  EXPECT_LT((end.x.head<2>() - at).norm(), 1.0);
  EXPECT_LT(end.x.segment<2>(2).norm(), 2.0);
}

TEST_P(EveryEstimator, AnObservationExplainsWhatItMade) {
  for (const sensors::Observation& z : {position(20.0, -7.0, 0.2), radar(25.0, 2.0, -6.0, 0.3, 0.02, 0.2)}) {
    const double distance_squared = estimator->distance_squared(estimator->initial(z), z).value();
    if (config.filter == config::FilterKind::kExtended)
      EXPECT_LT(distance_squared, 1e-20);
    else
      EXPECT_LT(distance_squared, 0.05) << "sigma points know that ranges around a position are longer";
  }
}

TEST_P(EveryEstimator, AnObservationAtTheOriginChangesNothing) {
  Estimate estimate = estimator->initial(position(0.0, 0.0, 0.5));
  const Estimate before = estimate;
  const sensors::Observation z = radar(0.1, 0.0, 0.0, 0.3, 0.03, 0.3);
  EXPECT_FALSE(estimator->distance_squared(estimate, z).has_value());
  estimator->update(estimate, z);
  EXPECT_TRUE(same_bits(estimate, before));
}

// A minute at a red light: the heading's uncertainty never exceeds an unknown one's. The car is followed again
// when it drives off.
TEST_P(EveryEstimator, AnObjectThatStoodForAMinuteDrivesOff) {
  RandomStream stream({.seed = 8});
  double y = 0.0, speed = 10.0;
  Estimate estimate = estimator->initial(position(20.0, y, 0.2));
  const std::size_t at_first = estimate.index();
  for (int k = 1; k <= 1500; ++k) {
    speed = k < 40 ? 10.0 : k < 1300 ? std::max(0.0, speed - 0.2) : std::min(10.0, speed + 0.1);
    y += 0.05 * speed;
    estimator->predict(estimate, 0.05);
    estimator->update(estimate, position(20.0 + 0.2 * stream.normal(), y + 0.2 * stream.normal(), 0.2));
    expect_lawful(estimate, k);
    if (const auto* polar = std::get_if<linear::Gaussian<5>>(&estimate)) {
      ASSERT_LE(polar->p(2, 2), kPi * kPi / 3.0 * (1.0 + 1e-12)) << k;
    }
    if (k == 60 || k == 1500) {
      EXPECT_EQ(estimate.index() != at_first, needs_course()) << "it drives";
    }
    if (k == 1299) {
      EXPECT_EQ(estimate.index(), at_first) << "and has stood";
    }
    if (k < 100) continue;
    const State x = estimator->cartesian(estimate).x;
    ASSERT_LT((x.head<2>() - linear::Vector<2>(20.0, y)).norm(), 1.0) << k;
    ASSERT_LT((x.segment<2>(2) - linear::Vector<2>(0.0, speed)).norm(), 3.0) << k;
  }
}

// A car that drives off becomes polar within a second. A standing car never does, and is never known to move.
TEST_P(EveryEstimator, ACourseIsKnownBeforeItIsBelieved) {
  for (const double speed : {0.0, 10.0}) {
    RandomStream stream({.seed = 7});
    Estimate estimate = estimator->initial(position(20.0, 5.0, 0.2));
    const std::size_t at_first = estimate.index();
    for (int k = 1; k <= 40; ++k) {
      estimator->predict(estimate, 0.05);
      const double y = 5.0 + 0.05 * k * speed;
      estimator->update(estimate, position(20.0 + 0.2 * stream.normal(), y + 0.2 * stream.normal(), 0.2));
    }
    EXPECT_EQ(estimate.index() != at_first, needs_course() && speed > 0.0) << speed;
    EXPECT_NEAR(estimator->cartesian(estimate).x(3), speed, 1.5);
    EXPECT_NEAR(estimator->cartesian(estimate).x(2), 0.0, 1.5);
  }
}

}  // namespace
}  // namespace ttf::fusion::estimators
