// The error that a schedule must be expected to leave, without drawing anything: the covariance recursion of the Kalman
// filter over what a strategy knows at every instant of use.
//
// A point moves at constant velocity but for white acceleration, and sensors say where it is, without bias. Then the
// error is
//   P(t + dt) = F P F' + Q(dt),   F = [I, I dt; 0, I],   Q(dt) = [D dt^3/3, D dt^2/2; D dt^2/2, D dt]
//   P+ = (I - K H) P (I - K H)' + K R K',   H = [I, 0],   K = A H' (H A H' + R)^-1,
// where A follows the same recursion with what the filter assumes, so that a filter with a wrong density has its error
// told, too; where it is right, P = A. Nothing in it depends on what is measured (Bar-Shalom, Li, Kirubarajan:
// "Estimation with Applications to Tracking and Navigation", 2001, 5.2.3 and 5.3.1). BUFF, ADVA and TT differ in what
// they have fused by a use, and in nothing else: what is fused late counts as if it had come in order.
//
// States (x, y, vx, vy) [m, m/s]; written on its own, so that the filters in fusion/ can be held against it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/time.h"

namespace ttf::experiments::sweep {

struct PointMotion {
  // Spectral densities of the acceleration [m^2/s^3], symmetric.
  Eigen::Matrix2d assumed = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d actual = Eigen::Matrix2d::Identity();
  // Of the velocity when the first measurement is made, which says nothing of it [m^2/s^2]: the variance that the
  // filter assumes, and the expected square of what it is off from nothing.
  Eigen::Matrix2d assumed_velocity = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d actual_velocity = Eigen::Matrix2d::Identity();
  // That a filter knows: the same for both.
  static PointMotion known(double density, double velocity_sigma);
};

// A measurement of the position: its covariance [m^2], positive definite.
struct Look {
  GlobalTime measured{};
  Eigen::Matrix2d noise = Eigen::Matrix2d::Identity();
};

class ErrorRecursion {
 public:
  explicit ErrorRecursion(const PointMotion& motion) : motion_(motion) {}

  // In any order: one that is older than others is taken in before them.
  void fuse(const Look& look);
  bool empty() const { return steps_.empty(); }
  // The expected square of the error of what is predicted to `use`; nothing must be fused that is newer, and something
  // must be.
  Eigen::Matrix4d at(GlobalTime use) const;

 private:
  struct Step {
    Look look;
    // With it.
    Eigen::Matrix4d assumed = Eigen::Matrix4d::Zero(), actual = Eigen::Matrix4d::Zero();
  };
  PointMotion motion_;
  std::vector<Step> steps_;  // in the order of measurement
};

}  // namespace ttf::experiments::sweep
