#include "experiments/sweep/expected_error.h"

#include <Eigen/LU>
#include <algorithm>

#include "core/check.h"

namespace ttf::experiments::sweep {
namespace {

Eigen::Matrix4d blocks(const Eigen::Matrix2d& position, const Eigen::Matrix2d& mixed, const Eigen::Matrix2d& velocity) {
  Eigen::Matrix4d all;
  all << position, mixed, mixed.transpose(), velocity;
  return all;
}

Eigen::Matrix4d moved_on(const Eigen::Matrix4d& p, const Eigen::Matrix2d& density, double dt) {
  Eigen::Matrix4d f = Eigen::Matrix4d::Identity();
  f.topRightCorner<2, 2>() = dt * Eigen::Matrix2d::Identity();
  return f * p * f.transpose() + blocks(density * (dt * dt * dt / 3.0), density * (dt * dt / 2.0), density * dt);
}

Eigen::Matrix4d corrected(const Eigen::Matrix4d& p, const Eigen::Matrix<double, 4, 2>& gain,
                          const Eigen::Matrix2d& noise) {
  Eigen::Matrix4d rest = Eigen::Matrix4d::Identity();
  rest.leftCols<2>() -= gain;
  return rest * p * rest.transpose() + gain * noise * gain.transpose();
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
      step->actual = blocks(noise, Eigen::Matrix2d::Zero(), motion_.actual_velocity);
      continue;
    }
    const Step& before = *(step - 1);
    const double dt = seconds_between(before.look.measured, step->look.measured);
    const Eigen::Matrix4d assumed = moved_on(before.assumed, motion_.assumed, dt);
    const Eigen::Matrix2d innovation = assumed.topLeftCorner<2, 2>() + noise;
    const Eigen::Matrix<double, 4, 2> gain = assumed.leftCols<2>() * innovation.inverse();
    step->assumed = corrected(assumed, gain, noise);
    step->actual = corrected(moved_on(before.actual, motion_.actual, dt), gain, noise);
  }
}

Eigen::Matrix4d ErrorRecursion::at(GlobalTime use) const {
  TTF_CHECK(!steps_.empty(), "an error of nothing");
  const Step& last = steps_.back();
  const double dt = seconds_between(last.look.measured, use);
  TTF_CHECK(dt >= 0.0, "a measurement {} s after it is used", -dt);
  return moved_on(last.actual, motion_.actual, dt);
}

}  // namespace ttf::experiments::sweep
