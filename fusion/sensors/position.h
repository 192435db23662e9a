// z = (x, y) [m].
#pragma once

#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::sensors {

struct Position {
  static constexpr const char* kName = "Position";
  static constexpr int kDimension = 2, kParts = motion::kPositionOnly;
  static constexpr bool kLinear = true, kDirect = true;

  linear::Vector<2> expected(const motion::Kinematics& k) const { return k.position; }
  linear::Matrix<2, 2> jacobian(const motion::Kinematics&) const { return linear::Matrix<2, 2>::Identity(); }
  linear::Vector<2> residual(const linear::Vector<2>& z, const linear::Vector<2>& e) const { return z - e; }
  bool sees(const motion::Kinematics&) const { return true; }
};
static_assert(Direct<Position>);

}  // namespace ttf::fusion::sensors
