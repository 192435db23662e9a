// Converts range and bearing to a position without bias, for sensors that do not measure the range rate.
//
//   lambda = exp(-sb^2 / 2),   (x, y) = r (cos b, sin b) / lambda
//   R11 = c r^2 cos^2 b + (r^2 + sr^2) (1 + lambda^4 cos 2b) / 2,       c = lambda^-2 - 2
//   R22 = c r^2 sin^2 b + (r^2 + sr^2) (1 - lambda^4 cos 2b) / 2
//   R12 = c r^2 sin b cos b + (r^2 + sr^2) lambda^4 sin 2b / 2
// (Longbin, Xiaoquan, Yiyu, Kang, Bar-Shalom: "Unbiased converted measurements for tracking", IEEE TAES 34(3),
// 1998, pp. 1023-1027.) The code computes the variances along and across the line of sight:
//   along:   r^2 (lambda^-2 - 2 + (1 + lambda^4) / 2) + sr^2 (1 + lambda^4) / 2
//   across:  (r^2 + sr^2) (1 - lambda^4) / 2
// It uses expm1, so that small noise at a large range survives the difference of large numbers.
//
// Drawings and records need only the first-order transformation: plane_position().
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "fusion/sensors/mounted.h"
#include "fusion/sensors/observation.h"
#include "fusion/sensors/plane_position.h"

namespace ttf::fusion::sensors {

// Takes a range r > 0 [m] and a bearing b [rad, from x to y] with independent errors of sigma sr > 0 and 0 < sb
// < 1.
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

// Returns the object's position in the vehicle's axes. A placed position (fusion/sensors/known_sensor.h) stays
// as it is; range and bearing are converted to first order, from the sensor's mounting `from`.
inline PlanePosition plane_position(const Observation& observation, const Mounting& from) {
  if (observation.kind == ObservationKind::kPosition)
    return {observation.z(0), observation.z(1), observation.r(0, 0), observation.r(0, 1), observation.r(1, 1)};
  const double range = observation.z(0), bearing = observation.z(1) + from.yaw;
  const double c = std::cos(bearing), s = std::sin(bearing);
  PlanePosition plane{from.position.x() + range * c, from.position.y() + range * s};
  plane.set_errors(c, s, observation.r(0, 0), range * range * observation.r(1, 1));
  return plane;
}

}  // namespace ttf::fusion::sensors
