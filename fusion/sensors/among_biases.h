// A sensor whose systematic errors are some of the biases of all sensors together (fusion/filters/consider.h): the same
// sensor, and d expected / d (all of them), zero but for its own.
//
// What a sensor errs by is in its own axes (fusion/sensors/known_sensor.h), polar or Cartesian; what it measures is
// either a position, which has been placed in the vehicle's axes, or range, bearing and range rate from where it is
// mounted. With q from the sensor to the object, p the position, v the velocity, all in the vehicle's axes:
//   polar errors of a position      q / |q| by the range, (-q_y, q_x) by the bearing
//   polar errors of range, bearing and range rate   one each
//   Cartesian errors                d expected / d p, by the sensor's axes
//   the stamp's error               d expected / d p, by v
#pragma once

#include <array>
#include <cmath>

#include "fusion/sensors/known_sensor.h"
#include "fusion/sensors/range_bearing.h"
#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::sensors {

// Where a sensor's biases are among all, and where the sensor is. Index -1: it has no such error.
struct OwnBiases {
  std::array<int, 4> index{-1, -1, -1, -1};  // of the components (SystematicErrors::sigma), the stamp last
  ErrorAxes axes = ErrorAxes::kPolar;
  Mounting mounting{};
  double time_variance = 0.0;  // [s^2]
};

template <Model S> struct AmongBiases {
  static_assert(S::kParts <= motion::kWithVelocity && (S::kDimension == 2 || S::kDimension == 3));
  static constexpr int kDimension = S::kDimension, kParts = motion::kWithVelocity, kBiases = kMostBiases;
  static constexpr bool kLinear = S::kLinear;

  S sensor;  // in the vehicle's axes
  const OwnBiases& own;

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
      const double c = std::cos(own.mounting.yaw), s = std::sin(own.mounting.yaw);
      put(0, by_position * linear::Vector<2>(c, s));
      put(1, by_position * linear::Vector<2>(-s, c));
    } else if constexpr (kDimension == 3) {
      for (int i = 0; i < 3; ++i) put(i, linear::Vector<3>::Unit(i));
    } else {
      const linear::Vector<2> q = k.position - own.mounting.position;
      if (const double range = q.norm(); range >= kNearest) put(0, q / range);
      put(1, linear::Vector<2>(-q.y(), q.x()));
    }
    put(3, by_position * k.velocity);
    return d;
  }
  linear::Vector<kDimension> residual(const linear::Vector<kDimension>& z, const linear::Vector<kDimension>& e) const {
    return sensor.residual(z, e);
  }
  bool sees(const motion::Kinematics& k) const { return sensor.sees(k); }
};

}  // namespace ttf::fusion::sensors
