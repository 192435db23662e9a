// A measurement model for tests: z = (x, y, orientation) [m, m, rad] of a box fitted to an outline. Front and back look alike, so the
// orientation is the heading up to half a turn.
#pragma once

#include <cmath>
#include <numbers>

#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::sensors {

struct PositionHeading {
  static constexpr const char* kName = "PositionHeading";
  static constexpr int kDimension = 3, kParts = motion::kWithHeading;
  static constexpr bool kLinear = false;

  linear::Vector<3> expected(const motion::Kinematics& k) const { return {k.position.x(), k.position.y(), k.heading}; }
  linear::Matrix<3, 5> jacobian(const motion::Kinematics&) const {
    linear::Matrix<3, 5> h = linear::Matrix<3, 5>::Zero();
    h(0, 0) = h(1, 1) = h(2, 4) = 1.0;
    return h;
  }
  linear::Vector<3> residual(const linear::Vector<3>& z, const linear::Vector<3>& e) const {
    linear::Vector<3> d = z - e;
    d(2) = std::remainder(d(2), std::numbers::pi);
    return d;
  }
  bool sees(const motion::Kinematics& k) const { return k.has_heading; }
};
static_assert(Model<PositionHeading>);

}  // namespace ttf::fusion::sensors
