// Range rates that a radar measures up to multiples of a span (fusion/sensors/range_bearing_rate.h).
//
// The residual is the nearest of all that are possible. It is the right one if the prediction is certain enough. Otherwise the
// rate says nothing: it would move the velocity to a value that may be any.
#pragma once

#include <cmath>

#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::estimators {

inline constexpr double kNoRate = 1e6;  // [m^2/s^2], the variance of a range rate that does not count

// Returns whether three standard deviations of the residual, to either side, are within the span [m/s].
inline bool rate_counts(double span, double variance) { return 36.0 * variance <= span * span; }

// Takes a range rate out of a measurement if it does not count. `velocity` is the covariance of the object's velocity, and the
// line of sight has this azimuth [rad], both in the vehicle's axes.
inline void doubt_rate(sensors::Measurement<3>& z, double span, double azimuth, const linear::Matrix<2>& velocity) {
  const linear::Vector<2> sight(std::cos(azimuth), std::sin(azimuth));
  if (rate_counts(span, sight.dot(velocity * sight) + z.r(2, 2))) return;
  z.r.row(2).setZero();
  z.r.col(2).setZero();
  z.r(2, 2) = kNoRate;
}

}  // namespace ttf::fusion::estimators
