// Wraps a sensor whose systematic errors are some of the biases of all sensors together
// (fusion/filters/consider.h). The derivative d expected / d (all biases) is zero except for the sensor's own
// biases.
//
// A sensor's errors are in its own axes (fusion/sensors/known_sensor.h), polar or Cartesian. Its measurement is
// a position that is already placed in the tracks' axes, or range, bearing and range rate from its place there.
// The derivatives are as follows, with q the vector from sensor to object, p the position and v the velocity,
// all in the tracks' axes:
//   polar errors of a position      q / |q| for the range, (-q_y, q_x) for the bearing
//   polar errors of range, bearing and range rate   one each
//   Cartesian errors                d expected / d p, along the sensor's axes
//   the time stamp's error          d expected / d p, along v - w, where the sensor moves with w; its turn moves a
//                                   placed position by -yaw_rate (-q_y, q_x), and a bearing by -yaw_rate
// A position was placed by the pose at its stamp, but the sensor had moved on and turned. Changes of w are neglected.
#pragma once

#include <array>
#include <cmath>

#include "fusion/sensors/known_sensor.h"
#include "fusion/sensors/range_bearing.h"
#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::sensors {

// The indices of a sensor's biases among all. Index -1 means that it has no such error.
struct OwnBiases {
  std::array<int, 4> index{-1, -1, -1, -1};  // by component (SystematicErrors::sigma), the time stamp last
  ErrorAxes axes = ErrorAxes::kPolar;
  double time_variance = 0.0;  // [s^2]
};

template <Model S> struct AmongBiases {
  static_assert(S::kParts <= motion::kWithVelocity && (S::kDimension == 2 || S::kDimension == 3));
  static constexpr int kDimension = S::kDimension, kParts = motion::kWithVelocity, kBiases = kMostBiases;
  static constexpr bool kLinear = S::kLinear;

  S sensor;  // in the tracks' axes
  const OwnBiases& own;
  const Mounting& from;  // the sensor's place there

  linear::Vector<kDimension> expected(const motion::Kinematics& k) const { return sensor.expected(k); }
  linear::Matrix<kDimension, kParts> jacobian(const motion::Kinematics& k) const {
    linear::Matrix<kDimension, kParts> h = linear::Matrix<kDimension, kParts>::Zero();
    h.template leftCols<S::kParts>() = sensor.jacobian(k);
    return h;
  }
  linear::Matrix<kDimension, kBiases> bias_jacobian(const motion::Kinematics& k) const {
    const linear::Matrix<kDimension, 2> by_position = sensor.jacobian(k).template leftCols<2>();
    linear::Matrix<kDimension, kBiases> d = linear::Matrix<kDimension, kBiases>::Zero();
    const auto put = [&](int component, const linear::Vector<kDimension>& column) {
      if (const int i = own.index[static_cast<std::size_t>(component)]; i >= 0) d.col(i) = column;
    };
    if (own.axes == ErrorAxes::kCartesian) {
      const double c = std::cos(from.yaw), s = std::sin(from.yaw);
      put(0, by_position * linear::Vector<2>(c, s));
      put(1, by_position * linear::Vector<2>(-s, c));
    } else if constexpr (kDimension == 3) {
      for (int i = 0; i < 3; ++i) put(i, linear::Vector<3>::Unit(i));
    } else {
      const linear::Vector<2> q = k.position - from.position;
      if (const double range = q.norm(); range >= kNearest) put(0, q / range);
      put(1, linear::Vector<2>(-q.y(), q.x()));
    }
    put(3, by_position * linear::Vector<2>(k.velocity - from.velocity));
    if (from.yaw_rate != 0.0 && own.index[3] >= 0) {
      if constexpr (kDimension == 3)
        d(1, own.index[3]) -= from.yaw_rate;
      else
        d.col(own.index[3]) -= from.yaw_rate * quarter_on(k.position - from.position);
    }
    return d;
  }
  linear::Vector<kDimension> residual(const linear::Vector<kDimension>& z, const linear::Vector<kDimension>& e) const {
    return sensor.residual(z, e);
  }
  bool sees(const motion::Kinematics& k) const { return sensor.sees(k); }

 private:
  static linear::Vector<2> quarter_on(const linear::Vector<2>& a) { return {-a.y(), a.x()}; }
};

}  // namespace ttf::fusion::sensors
