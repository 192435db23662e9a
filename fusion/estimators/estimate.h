// The estimate of one object, in the layout of its estimator (fusion/estimators/estimator.h). It is a value of
// fixed size, and a copy copies only the held alternative. Only estimators look inside; others call position()
// or cartesian(). The alternative is part of the belief: an object of unknown course has no polar state,
// whatever the model (fusion/estimators/model_estimator.h).
#pragma once

#include <variant>

#include "fusion/filters/considered.h"
#include "fusion/filters/modes.h"
#include "fusion/linear/gaussian.h"
#include "fusion/motion/constant_velocity.h"
#include "fusion/motion/ctrv.h"
#include "fusion/sensors/known_sensor.h"

namespace ttf::fusion::estimators {

// (x, y, vx, vy, ax, ay) in metres and seconds, in ISO 8855 axes, for images and metrics. A component that a
// model fixes at zero is zero with zero variance.
using State = linear::Vector<6>;
using Covariance = linear::Matrix<6>;
using Cartesian = linear::Gaussian<6>;
inline linear::Gaussian<2> velocity_of(const Cartesian& estimate) {
  return {estimate.x.segment<2>(2), estimate.p.block<2, 2>(2, 2)};
}

using StraightOrTurning = filters::Modes<motion::ConstantVelocity, motion::Ctrv>;
template <int N> using WithBiases = filters::Considered<N, sensors::kMostBiases>;
using Estimate = std::variant<linear::Gaussian<4>, linear::Gaussian<5>, linear::Gaussian<6>, StraightOrTurning,
                              WithBiases<4>, WithBiases<6>>;

// The distance [m] of two points of an object: its mean and covariance.
struct Displacement {
  linear::Vector<2> by = linear::Vector<2>::Zero();
  linear::Matrix<2> spread = linear::Matrix<2>::Zero();
};

}  // namespace ttf::fusion::estimators
