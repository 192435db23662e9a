// A position from range and bearing, for a sensor that tells no range rate: unbiased polar-to-Cartesian conversion.
//
//   lambda = exp(-sb^2 / 2),   (x, y) = r (cos b, sin b) / lambda
//   R11 = c r^2 cos^2 b + (r^2 + sr^2) (1 + lambda^4 cos 2b) / 2,       c = lambda^-2 - 2
//   R22 = c r^2 sin^2 b + (r^2 + sr^2) (1 - lambda^4 cos 2b) / 2
//   R12 = c r^2 sin b cos b + (r^2 + sr^2) lambda^4 sin 2b / 2
// (Longbin, Xiaoquan, Yiyu, Kang, Bar-Shalom: "Unbiased converted measurements for tracking", IEEE TAES 34(3), 1998,
// pp. 1023-1027.) Computed along and across the line of sight, where it is
//   along:   r^2 (lambda^-2 - 2 + (1 + lambda^4) / 2) + sr^2 (1 + lambda^4) / 2
//   across:  (r^2 + sr^2) (1 - lambda^4) / 2
// and with expm1, so that little noise far away is not lost in the difference of large numbers.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "fusion/sensors/observation.h"

namespace ttf::fusion::sensors {

// range r > 0 [m] and bearing b [rad, from x to y], of independent errors with sigmas sr > 0 and 0 < sb < 1.
inline Observation converted_position(double range, double bearing, double sigma_range, double sigma_bearing) {
  const double v = sigma_bearing * sigma_bearing;
  // With e = expm1(v) = lambda^-2 - 1 and f = -expm1(-2v) = 1 - lambda^4.
  const double e = std::expm1(v), f = -std::expm1(-2.0 * v);
  const double r2 = range * range, s2 = sigma_range * sigma_range;
  const double along = r2 * (e - 0.5 * f) + s2 * (1.0 - 0.5 * f), across = 0.5 * f * (r2 + s2);
  const double c = std::cos(bearing), s = std::sin(bearing), scale = range * std::exp(0.5 * v);
  Observation observation;
  observation.kind = ObservationKind::kPosition;
  observation.z.head<2>() = Eigen::Vector2d(scale * c, scale * s);
  observation.r(0, 0) = along * c * c + across * s * s;
  observation.r(1, 1) = along * s * s + across * c * c;
  observation.r(0, 1) = observation.r(1, 0) = (along - across) * s * c;
  return observation;
}

}  // namespace ttf::fusion::sensors
