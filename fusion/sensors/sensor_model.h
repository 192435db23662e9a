// What a sensor model is. A new one is a small header over the kinematics (fusion/motion/kinematics.h), in the sensor's
// own axes; what it is systematically wrong by (systematic.h) is put around it, and where it is mounted (mounted.h)
// around both: Mounted<Systematic<S>>, in this order only.
//   kDimension     numbers of one measurement;
//   kParts         which kinematics it depends on: kPositionOnly, kWithVelocity, kWithHeading;
//   expected(k)    the measurement of noise-free sight of k;
//   jacobian(k)    d expected / d (the first kParts of x, y, vx, vy, heading);
//   residual(z, e) z - e, angles wrapped;
//   sees(k)        whether that derivative exists: not at range zero, nor of a heading that is not known.
// Laws, tested over every sensor: jacobian is the derivative of expected wherever sees; residual(z, z) is zero.
// A sensor that reads the leading components of the state as they are, H = [I 0], may say `kDirect = true`.
#pragma once

#include <concepts>

#include "fusion/motion/kinematics.h"

namespace ttf::fusion::sensors {

// z with the covariance of its white noise, symmetric positive definite. That is a promise of whoever makes one, for
// every update factors S = H P H' + R and stops the program at a pivot that is not positive (filters/ldl.h): what comes
// from outside is checked where it enters, a sensor's noise when its configuration is loaded, a covariance that a
// message carries when it is unpacked, by positive_definite() there. R must also not drown in the rounding of H P H':
// 1e-12 of it is enough. The methods of fusion/oosm/ ask the same of R (fusion/linear/gaussian.h); that their
// whitening.h lets pivots of zero pass is for predicted covariances and process noise, which may be semi-definite.
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

// One that knows its place on the vehicle: its kinematics are not in the sensor's own axes.
template <class S>
concept Placed = Model<S> && requires {
  requires S::kPlaced;
};

// One with systematic errors: d expected / d (what it is wrong by).
template <class S>
concept Biased = Model<S> && requires(const S& sensor, const motion::Kinematics& k) {
  { sensor.bias_jacobian(k) } -> std::same_as<linear::Matrix<S::kDimension, S::kBiases>>;
};

}  // namespace ttf::fusion::sensors
