// Linearises a sensor model at a state of a motion model, by the chain rule, for all pairs of models.
#pragma once

#include "fusion/motion/motion_model.h"
#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::filters {

// Returns H_c = d expected / d (the leading components of the state); the measurement depends on no others.
template <motion::Model M, sensors::Model S>
linear::Matrix<S::kDimension, motion::leading_columns(S::kParts)> measurement_matrix(
    const S& sensor, const motion::Kinematics& k, const linear::Vector<M::kStates>& x) {
  const linear::Matrix<S::kDimension, S::kParts> h = sensor.jacobian(k);
  if constexpr (S::kParts == motion::kPositionOnly || (S::kParts == motion::kWithVelocity && M::kCartesian))
    return h;
  else
    return h * M::kinematics_jacobian(x).template topRows<S::kParts>();
}

}  // namespace ttf::fusion::filters
