// The expected error of a heading, without any draws, for an object that drives straight on.
//
// A tracker follows heading and turn rate (fusion/tracks/body/heading.h): the rate forgets with T = 2 s0^2 / turn_noise, has the
// standard deviation s = min(s0, 0.2/m speed), and the heading wanders with heading_noise. With l = exp(-dt / T) and
// g = T (1 - l):
//   A(t + dt) = F A F' + Q,   F = [1, g; 0, l],
//   Q = [heading_noise dt + s^2 T (2 dt - 2 g - g^2 / T), .; s^2 g^2 / T, s^2 (1 - l^2)]
// Sensors measure the heading. The object does not turn. So the error's moments follow the same recursion with Q = 0.
#pragma once

#include <Eigen/Core>

#include "core/time.h"
#include "fusion/config/tracker_config.h"

namespace ttf::experiments::sweep {

class HeadingRecursion {
 public:
  explicit HeadingRecursion(const fusion::config::TrackerConfig& tracker) : tracker_(tracker) {}

  // Takes in an axis of this variance [rad^2], at this speed [m/s]. One that is older than the newest counts as of that
  // instant.
  void see(GlobalTime measured, double variance, double speed);
  bool known() const { return known_; }

  // The tracker's covariance of (heading, turn rate) [rad, rad/s], and that of the error. Before the first axis, only the rate
  // has a variance, and its estimate is right.
  struct Moments {
    Eigen::Matrix2d believed = Eigen::Matrix2d::Zero(), actual = Eigen::Matrix2d::Zero();
  };
  Moments at(GlobalTime use, double speed) const;

 private:
  // The turn rate's standard deviation [rad/s] at this speed.
  double rate_sigma(double speed) const;
  void predict(double dt, double speed);

  fusion::config::TrackerConfig tracker_;
  bool known_ = false;
  GlobalTime newest_{};
  Moments moments_;
};

}  // namespace ttf::experiments::sweep
