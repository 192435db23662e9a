// A sensor model is a small header over the kinematics (fusion/motion/kinematics.h) in the sensor's own axes.
// Systematic errors (tests/fusion/sensors/systematic.h) wrap the model, and the mounting (mounted.h) wraps both. The only order is
// Mounted<Systematic<S>>. A model has:
//   kDimension     numbers of one measurement;
//   kParts         the kinematics that it depends on: kPositionOnly, kWithVelocity, kWithHeading;
//   expected(k)    the measurement of k without noise;
//   jacobian(k)    d expected / d (the first kParts of x, y, vx, vy, heading);
//   residual(z, e) z - e, angles wrapped;
//   sees(k)        whether that derivative exists: false at range zero and for an unknown heading.
// Tests hold every sensor to two laws: jacobian is the derivative of expected wherever sees() holds, and
// residual(z, z) is zero. A sensor that reads the leading components of the state unchanged, H = [I 0], may set
// `kDirect = true`.
#pragma once

#include <concepts>

#include "fusion/motion/kinematics.h"

namespace ttf::fusion::sensors {

// z with the covariance of its white noise. The covariance must be symmetric positive definite: every update
// factors S = H P H' + R, and a pivot that is not positive stops the program (filters/ldl.h). So
// positive_definite() there checks covariances where they enter. A sensor's noise enters when its configuration
// is loaded, a message's covariance when it is unpacked. R must also exceed the rounding of H P H'; 1e-12 of it
// is enough.
//
// The methods of fusion/oosm/ ask the same of R. Their whitening.h lets zero pivots pass only for predicted
// covariances and process noise, which may be semi-definite.
template <int M> struct Measurement {
  linear::Vector<M> z = linear::Vector<M>::Zero();
  linear::Matrix<M> r = linear::Matrix<M>::Identity();
};

template <class S>
concept Model = requires(const S& sensor, const motion::Kinematics& k, const linear::Vector<S::kDimension>& z) {
  requires S::kParts == motion::kPositionOnly || S::kParts == motion::kWithVelocity ||
      S::kParts == motion::kWithHeading;
  { S::kLinear } -> std::convertible_to<bool>;
  { sensor.expected(k) } -> std::same_as<linear::Vector<S::kDimension>>;
  { sensor.jacobian(k) } -> std::same_as<linear::Matrix<S::kDimension, S::kParts>>;
  { sensor.residual(z, z) } -> std::same_as<linear::Vector<S::kDimension>>;
  { sensor.sees(k) } -> std::same_as<bool>;
};

template <class S>
concept Direct = Model<S> && S::kLinear && requires {
  requires S::kDirect;
};

// A sensor with a mounting; its kinematics are in the vehicle's axes, not in its own.
template <class S>
concept Placed = Model<S> && requires {
  requires S::kPlaced;
};

// A sensor with systematic errors; bias_jacobian is d expected / d (errors).
template <class S>
concept Biased = Model<S> && requires(const S& sensor, const motion::Kinematics& k) {
  { sensor.bias_jacobian(k) } -> std::same_as<linear::Matrix<S::kDimension, S::kBiases>>;
};

}  // namespace ttf::fusion::sensors
