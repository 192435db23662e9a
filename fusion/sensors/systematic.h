// A sensor that is wrong the same way every time:  z = h(k(t + tau)) + b + v.
//   b    constant bias of the measurement, in its units;
//   tau  constant bias of its time stamp [s]: what is stamped t was measured at t + tau, when the object was further by
//        velocity * tau (to first order).
// All of it in the sensor's own axes: b belongs to its measurements, and within tau the object moves by its velocity
// relative to the sensor. So a sensor on a vehicle is Mounted<Systematic<S>> (mounted.h), which hands k over relative
// to the sensor; Systematic<Mounted<S>> would move the object over ground and leave the vehicle where it was, and is
// refused. That the vehicle turns within tau is neglected: an error of yaw rate * tau in the bearing.
// What is known of them is corrected for, as expected() says. What is not known, their errors, is carried by the
// Schmidt form (fusion/filters/consider.h) through bias_jacobian, d expected / d (b, tau).
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
