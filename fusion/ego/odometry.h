// Odometry measures how a vehicle drives: the speed of its rear axle's middle along its x axis, and its yaw rate. Its errors are
//   measured speed = (1 + speed_scale) speed + white noise,   measured yaw rate = yaw rate + yaw_rate_bias + white noise.
// In a bend the rear axle drifts outwards. With linear tyres, the angle of slip is a constant times the lateral acceleration
// v w, so that the axle's middle moves at -slip v^2 w to the left.
#pragma once

#include "core/time.h"

namespace ttf::fusion::ego {

struct OdometrySample {
  GlobalTime at{};
  double speed = 0.0;                              // [m/s]
  double yaw_rate = 0.0;                           // [rad/s]
  double speed_sigma = 0.0, yaw_rate_sigma = 0.0;  // the noise's
};

struct OdometryErrors {
  double speed_sigma = 0.05;                     // [m/s], of the samples' noise, for the process noise of the tracks
  double yaw_rate_sigma = 0.002;                 // [rad/s]
  Duration period = Duration::milliseconds(20);  // the samples'; a schedule states it
  // Known constant errors are subtracted. The rest has these sigmas, for worn tyres and a warm gyroscope.
  double speed_scale = 0.0, speed_scale_sigma = 0.005;
  double yaw_rate_bias = 0.0, yaw_rate_bias_sigma = 0.002;  // [rad/s]
  // By so much the vehicle accelerates and turns harder unseen, after the newest sample.
  double acceleration_sigma = 2.0;                     // [m/s^2]
  double yaw_acceleration_sigma = 0.5;                 // [rad/s^2]
  double slip = 0.0;                                   // [rad s^2/m], of the rear tyres; 0: they do not slip
  double lever = 50.0;                                 // [m], to the objects that the noise of the frame is stated for
  Duration longest_age = Duration::milliseconds(200);  // an older newest sample means that the odometry has stopped

  // The spectral density [m^2/s] of the walk of an object that stands, in the odometry frame. Linear interpolation of samples
  // with the variance s^2 and the period T integrates to a walk of the density s^2 T.
  double drift_density() const {
    const double turn = yaw_rate_sigma * lever;
    return (speed_sigma * speed_sigma + turn * turn) * period.seconds();
  }
};

}  // namespace ttf::fusion::ego
