// A sensor at its mounting on the vehicle. It receives the object's kinematics in the vehicle's axes and sees
// them in its own:
//   p' = R' (p - t),  v' = R' (v - w),  heading' = heading - yaw
// (t, yaw) is the mounting pose and w the sensor's own velocity over ground, in the vehicle's axes. A mounted
// sensor with systematic errors (tests/fusion/sensors/systematic.h) has the same errors, at the kinematics in its own axes.
#pragma once

#include <algorithm>
#include <cmath>

#include "fusion/sensors/mounting.h"
#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::sensors {

template <class S> struct BiasesOf {};
template <Biased S> struct BiasesOf<S> { static constexpr int kBiases = S::kBiases; };

template <Model S>
requires(!Placed<S>) class Mounted : public BiasesOf<S> {
 public:
  static constexpr int kDimension = S::kDimension, kParts = S::kParts;
  static constexpr bool kLinear = S::kLinear, kPlaced = true;

  explicit Mounted(const Mounting& mounting, const S& sensor = {}) : sensor_(sensor), mounting_(mounting) {
    const double c = std::cos(mounting.yaw), s = std::sin(mounting.yaw);
    back_ << c, s, -s, c;
  }

  linear::Vector<kDimension> expected(const motion::Kinematics& k) const { return sensor_.expected(from_here(k)); }
  linear::Matrix<kDimension, kParts> jacobian(const motion::Kinematics& k) const {
    linear::Matrix<kDimension, kParts> h = sensor_.jacobian(from_here(k));
    constexpr int kVectors = std::min(kParts, static_cast<int>(motion::kWithVelocity));
    for (int i = 0; i < kVectors; i += 2) h.template middleCols<2>(i) = (h.template middleCols<2>(i) * back_).eval();
    return h;
  }
  template <Biased B = S> linear::Matrix<kDimension, B::kBiases> bias_jacobian(const motion::Kinematics& k) const {
    return sensor_.bias_jacobian(from_here(k));
  }
  linear::Vector<kDimension> residual(const linear::Vector<kDimension>& z, const linear::Vector<kDimension>& e) const {
    return sensor_.residual(z, e);
  }
  bool sees(const motion::Kinematics& k) const { return sensor_.sees(from_here(k)); }

 private:
  motion::Kinematics from_here(const motion::Kinematics& k) const {
    return {back_ * (k.position - mounting_.position), back_ * (k.velocity - mounting_.velocity),
            k.heading - mounting_.yaw, k.has_heading};
  }

  S sensor_;
  Mounting mounting_;
  linear::Matrix<2> back_;  // R', from the vehicle's axes to the sensor's
};

}  // namespace ttf::fusion::sensors
