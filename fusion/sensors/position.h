// z = (x, y) [m].
#pragma once

#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::sensors {

struct Position {
  static constexpr const char* kName = "Position";
  static constexpr int kDimension = 2, kParts = kPositionOnly;
  static constexpr bool kLinear = true, kDirect = true;

  Vector<2> expected(const Kinematics& k) const { return k.position; }
  Matrix<2, 2> jacobian(const Kinematics&) const { return Matrix<2, 2>::Identity(); }
  Vector<2> residual(const Vector<2>& z, const Vector<2>& e) const { return z - e; }
  bool sees(const Kinematics&) const { return true; }
};
static_assert(Direct<Position>);

}  // namespace ttf::fusion::sensors
