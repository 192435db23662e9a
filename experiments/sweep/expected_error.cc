#include "experiments/sweep/expected_error.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace ttf::experiments::sweep {
namespace {

Eigen::Matrix4d blocks(const Eigen::Matrix2d& position, const Eigen::Matrix2d& mixed, const Eigen::Matrix2d& velocity) {
  Eigen::Matrix4d all;
  all << position, mixed, mixed.transpose(), velocity;
  return all;
}

Eigen::Matrix4d noise_of(const Eigen::Matrix2d& density, double dt) {
  return blocks(density * (dt * dt * dt / 3.0), density * (dt * dt / 2.0), density * dt);
}

Eigen::Matrix4d moved_on(const Eigen::Matrix4d& p, const Eigen::Matrix2d& density, double dt) {
  Eigen::Matrix4d f = Eigen::Matrix4d::Identity();
  f.topRightCorner<2, 2>() = dt * Eigen::Matrix2d::Identity();
  return f * p * f.transpose() + noise_of(density, dt);
}

// The density's factor in the variance of a way of dt with this memory. The exact form cancels for a short dt: there its
// series serves, which errs by 1e-8 of it.
double way_of_noise(double dt, double tau) {
  const double x = dt / tau;
  if (x < 3e-3) return dt * dt * dt * (1.0 / 3.0 - x / 4.0 + 7.0 / 60.0 * x * x);
  return tau * tau * tau * (x + 2.0 * std::expm1(-x) - 0.5 * std::expm1(-2.0 * x));
}

Matrix6d moved_on(const Matrix6d& p, const PointMotion& motion, double dt) {
  const double tau = motion.memory, forgot = -std::expm1(-dt / tau);
  Matrix6d f = Matrix6d::Identity();
  f.block<2, 2>(0, 2).diagonal().setConstant(dt);
  f.block<2, 2>(0, 4).diagonal().setConstant(tau * forgot - dt);
  f.block<2, 2>(2, 4).diagonal().setConstant(-forgot);
  f.block<2, 2>(4, 4).diagonal().setConstant(1.0 - forgot);
  Matrix6d moved = f * p * f.transpose();
  moved.topLeftCorner<4, 4>() += noise_of(motion.actual, dt);
  const Eigen::Matrix2d& d = motion.forgotten;
  const Eigen::Matrix2d way = d * way_of_noise(dt, tau), mixed = d * (0.5 * tau * tau * forgot * forgot),
                        speed = d * (-0.5 * tau * std::expm1(-2.0 * dt / tau));
  moved.topLeftCorner<4, 4>() += blocks(way, mixed, speed);
  moved.block<2, 2>(0, 4) += mixed;
  moved.block<2, 2>(4, 0) += mixed.transpose();
  moved.block<2, 2>(2, 4) += speed;
  moved.block<2, 2>(4, 2) += speed;
  moved.block<2, 2>(4, 4) += speed;
  return moved;
}

// A correction with this gain of the error's state; what stands behind it (n > 4) is not corrected.
template <int n>
Eigen::Matrix<double, n, n> corrected(const Eigen::Matrix<double, n, n>& p, const Eigen::Matrix<double, 4, 2>& gain,
                                      const Eigen::Matrix2d& noise) {
  Eigen::Matrix<double, n, n> rest = Eigen::Matrix<double, n, n>::Identity();
  rest.template topLeftCorner<4, 2>() -= gain;
  Eigen::Matrix<double, n, n> after = rest * p * rest.transpose();
  after.template topLeftCorner<4, 4>() += gain * noise * gain.transpose();
  return after;
}

double seconds_between(GlobalTime from, GlobalTime to) { return (to - from).seconds(); }

}  // namespace

PointMotion PointMotion::known(double density, double velocity_sigma) {
  PointMotion motion;
  motion.assumed = motion.actual = density * Eigen::Matrix2d::Identity();
  motion.assumed_velocity = motion.actual_velocity = velocity_sigma * velocity_sigma * Eigen::Matrix2d::Identity();
  return motion;
}

void ErrorRecursion::fuse(const Look& look) {
  const auto behind = std::upper_bound(steps_.begin(), steps_.end(), look.measured,
                                       [](GlobalTime at, const Step& step) { return at < step.look.measured; });
  auto step = steps_.insert(behind, Step{look});
  for (; step != steps_.end(); ++step) {
    const Eigen::Matrix2d& noise = step->look.noise;
    if (step == steps_.begin()) {
      step->assumed = blocks(noise, Eigen::Matrix2d::Zero(), motion_.assumed_velocity);
      const Eigen::Matrix2d forgotten = motion_.forgotten * (0.5 * motion_.memory);
      step->actual.topLeftCorner<4, 4>() = blocks(noise, Eigen::Matrix2d::Zero(), motion_.actual_velocity + forgotten);
      step->actual.block<2, 2>(2, 4) = step->actual.block<2, 2>(4, 2) = step->actual.block<2, 2>(4, 4) = forgotten;
      continue;
    }
    const Step& before = *(step - 1);
    const double dt = seconds_between(before.look.measured, step->look.measured);
    const Eigen::Matrix4d assumed = moved_on(before.assumed, motion_.assumed, dt);
    const Eigen::Matrix2d innovation = assumed.topLeftCorner<2, 2>() + noise;
    const Eigen::Matrix<double, 4, 2> gain = assumed.leftCols<2>() * innovation.inverse();
    step->assumed = corrected<4>(assumed, gain, noise);
    step->actual = corrected<6>(moved_on(before.actual, motion_, dt), gain, noise);
  }
}

double ErrorRecursion::seconds_to(GlobalTime use) const {
  TTF_CHECK(!steps_.empty(), "an error of nothing");
  const double dt = seconds_between(steps_.back().look.measured, use);
  TTF_CHECK(dt >= 0.0, "a measurement {} s after it is used", -dt);
  return dt;
}

Eigen::Matrix4d ErrorRecursion::at(GlobalTime use) const {
  const double dt = seconds_to(use);
  return moved_on(steps_.back().actual, motion_, dt).topLeftCorner<4, 4>();
}

Eigen::Matrix4d ErrorRecursion::believed(GlobalTime use) const {
  const double dt = seconds_to(use);
  return moved_on(steps_.back().assumed, motion_.assumed, dt);
}

}  // namespace ttf::experiments::sweep
