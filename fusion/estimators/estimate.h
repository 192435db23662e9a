// What is believed of one object, in the terms of the estimator that made it (fusion/estimators/estimator.h): a value
// of fixed size, that copies no more than it holds. Only an estimator looks inside; everybody else asks it for
// position() or cartesian(). Which alternative is held is part of the belief: an object whose course is not known yet
// has no polar state, whatever the model (fusion/estimators/model_estimator.h).
#pragma once

#include <variant>

#include "fusion/filters/considered.h"
#include "fusion/filters/modes.h"
#include "fusion/linear/gaussian.h"
#include "fusion/motion/constant_velocity.h"
#include "fusion/motion/ctrv.h"
#include "fusion/sensors/known_sensor.h"

namespace ttf::fusion::estimators {

// (x, y, vx, vy, ax, ay) in metres and seconds, ISO 8855 axes: what images and metrics speak of. What a model holds
// constant at zero is zero and certain.
using State = linear::Vector<6>;
using Covariance = linear::Matrix<6>;
using Cartesian = linear::Gaussian<6>;

using StraightOrTurning = filters::Modes<motion::ConstantVelocity, motion::Ctrv>;
template <int N> using WithBiases = filters::Considered<N, sensors::kMostBiases>;
using Estimate = std::variant<linear::Gaussian<4>, linear::Gaussian<5>, linear::Gaussian<6>, StraightOrTurning,
                              WithBiases<4>, WithBiases<6>>;

}  // namespace ttf::fusion::estimators
