// The expected error of a schedule, without any draws: the covariance recursion of the Kalman filter over the
// lists that a strategy has at every instant of use.
//
// A point moves at constant velocity with white acceleration, and sensors measure its position without bias.
// Then the error is
//   P(t + dt) = F P F' + Q(dt),   F = [I, I dt; 0, I],   Q(dt) = [D dt^3/3, D dt^2/2; D dt^2/2, D dt]
//   P+ = (I - K H) P (I - K H)' + K R K',   H = [I, 0],   K = A H' (H A H' + R)^-1,
// where A follows the same recursion with the filter's assumptions. P thus holds for a filter with a wrong
// density, too; with the right one, P = A. The recursion does not depend on measured values (Bar-Shalom, Li,
// Kirubarajan: "Estimation with Applications to Tracking and Navigation", 2001, 5.2.3 and 5.3.1). BUFF, ADVA
// and TT differ only in the lists fused by a use: a list fused late counts as if it had come in order.
//
// The true velocity may have a part u that forgets (sim/world/speed.h). The filter does not model that. Its error takes up
// what u forgets. So P is that of (error, u). With the density D, the memory tau and f = exp(-dt / tau):
//   u' = f u + w_u,   e_v' = e_v + (f - 1) u + w_u,   e_p' = e_p + dt e_v + (tau (1 - f) - dt) u + w_p,
//   E w_u^2 = D tau / 2 (1 - f^2),   E w_p w_u = D tau^2 / 2 (1 - f)^2,
//   E w_p^2 = D tau^2 (dt - 2 tau (1 - f) + tau / 2 (1 - f^2))
// (Gillespie: "Exact numerical simulation of the Ornstein-Uhlenbeck process and its integral", Physical Review E 54,
// 1996). u is stationary, and independent of the rest of the velocity.
//
// States are (x, y, vx, vy) [m, m/s], and u = (ux, uy) [m/s]. The code is independent of the filters in fusion/, so that
// tests can compare them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/time.h"

namespace ttf::experiments::sweep {

struct PointMotion {
  // Spectral densities of the acceleration [m^2/s^3], symmetric.
  Eigen::Matrix2d assumed = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d actual = Eigen::Matrix2d::Identity();
  // The density of the noise that the velocity forgets, beside `actual`, and the time constant [s], above zero.
  Eigen::Matrix2d forgotten = Eigen::Matrix2d::Zero();
  double memory = 1.0;
  // The filter's assumed variance of the velocity at the first measurement, which does not observe it, and the
  // expected square of the true velocity without the part that is forgotten [m^2/s^2].
  Eigen::Matrix2d assumed_velocity = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d actual_velocity = Eigen::Matrix2d::Identity();
  // A motion that the filter models: both are the same.
  static PointMotion known(double density, double velocity_sigma);
};

// A measurement of the position: its covariance [m^2], positive definite.
struct Look {
  GlobalTime measured{};
  Eigen::Matrix2d noise = Eigen::Matrix2d::Identity();
};

using Matrix6d = Eigen::Matrix<double, 6, 6>;

class ErrorRecursion {
 public:
  explicit ErrorRecursion(const PointMotion& motion) : motion_(motion) {}

  // Takes measurements in any order; an older one is inserted before the newer ones.
  void fuse(const Look& look);
  bool empty() const { return steps_.empty(); }
  // The newest measurement's instant. One must have been fused.
  GlobalTime newest() const { return steps_.back().look.measured; }
  // Returns the expected square of the error of the prediction to `use`. A measurement must have been fused,
  // and none newer than `use`.
  Eigen::Matrix4d at(GlobalTime use) const;
  // Returns the filter's own covariance of this prediction.
  Eigen::Matrix4d believed(GlobalTime use) const;

 private:
  struct Step {
    Look look;
    // After this measurement: the filter's covariance, and that of (error, u).
    Eigen::Matrix4d assumed = Eigen::Matrix4d::Zero();
    Matrix6d actual = Matrix6d::Zero();
  };
  double seconds_to(GlobalTime use) const;

  PointMotion motion_;
  std::vector<Step> steps_;  // in the order of measurement
};

}  // namespace ttf::experiments::sweep
