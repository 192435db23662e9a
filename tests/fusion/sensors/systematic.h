// A sensor with constant systematic errors:  z = h(k(t + tau)) + b + v.
//   b    bias of the measurement, in its units;
//   tau  bias of the time stamp [s]: a measurement stamped t happened at t + tau, when the object was further on by
//        velocity * tau (to first order).
// Both are in the sensor's own axes: b belongs to its measurements, and within tau the object moves by its
// velocity relative to the sensor. So a sensor on a vehicle is Mounted<Systematic<S>> (mounted.h), which passes
// k relative to the sensor. Systematic<Mounted<S>> does not compile: it would move the object over ground and
// leave the vehicle in place. The turn of the vehicle within tau is neglected; it is an error of yaw rate * tau
// in the bearing. expected() corrects for the known errors. The Schmidt filter (fusion/filters/consider.h)
// carries the unknown rest through bias_jacobian, d expected / d (b, tau).
#pragma once

#include <algorithm>

#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::sensors {

template <Model S>
requires(!Placed<S>) struct Systematic {
  static constexpr int kDimension = S::kDimension;
  static constexpr int kParts = std::max(S::kParts, static_cast<int>(motion::kWithVelocity));
  static constexpr bool kLinear = S::kLinear;
  static constexpr int kBiases = kDimension + 1;  // b, then tau

  S sensor{};
  linear::Vector<kDimension> bias = linear::Vector<kDimension>::Zero();
  double time_bias = 0.0;

  linear::Vector<kDimension> expected(const motion::Kinematics& k) const { return sensor.expected(then(k)) + bias; }
  linear::Matrix<kDimension, kParts> jacobian(const motion::Kinematics& k) const {
    linear::Matrix<kDimension, kParts> h = linear::Matrix<kDimension, kParts>::Zero();
    h.template leftCols<S::kParts>() = sensor.jacobian(then(k));
    h.template middleCols<2>(2) += time_bias * h.template leftCols<2>();
    return h;
  }
  linear::Matrix<kDimension, kBiases> bias_jacobian(const motion::Kinematics& k) const {
    linear::Matrix<kDimension, kBiases> d;
    d.template leftCols<kDimension>().setIdentity();
    d.col(kDimension) = sensor.jacobian(then(k)).template leftCols<2>() * k.velocity;
    return d;
  }
  linear::Vector<kDimension> residual(const linear::Vector<kDimension>& z, const linear::Vector<kDimension>& e) const {
    return sensor.residual(z, e);
  }
  bool sees(const motion::Kinematics& k) const { return sensor.sees(then(k)); }

 private:
  motion::Kinematics then(motion::Kinematics k) const {
    k.position += time_bias * k.velocity;
    return k;
  }
};

}  // namespace ttf::fusion::sensors
