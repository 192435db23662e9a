// The direction of an object's front: the course combined with the measured axis.
#pragma once

#include "fusion/estimators/estimate.h"
#include "fusion/tracks/body/heading.h"

namespace ttf::fusion::tracks::body {

// The direction of the object's front [rad]: the course combined with the measured axis, turned by half a turn
// if needed. A slow course against the remembered front is noise, and the axis counts alone. Without both, sigma is that of an
// unknown angle.
struct Facing {
  double heading = 0.0;
  double sigma = 0.0;
  linear::Vector<2> by_velocity = linear::Vector<2>::Zero();  // derivative of the heading by the velocity [rad s/m]
  double axis_variance = 0.0;  // the part of the variance that is not the velocity's [rad^2]
  double reversed = 0.0;       // probability that the front is at the axis' other end, which sigma does not contain
  double sigma_of_front() const;
};
Facing facing_of(const linear::Gaussian<2>& velocity, const Heading& axis);
inline Facing facing_of(const estimators::Cartesian& estimate, const Heading& axis) {
  return facing_of(estimators::velocity_of(estimate), axis);
}

}  // namespace ttf::fusion::tracks::body
