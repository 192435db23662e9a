// z = (range, bearing) [m, rad], the bearing from the x axis to the y axis.
#pragma once

#include <cmath>

#include "fusion/motion/angles.h"
#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::sensors {

// Nearer than this [m], an object has no bearing.
inline constexpr double kNearest = 1e-3;

struct RangeBearing {
  static constexpr const char* kName = "RangeBearing";
  static constexpr int kDimension = 2, kParts = kPositionOnly;
  static constexpr bool kLinear = false;

  Vector<2> expected(const Kinematics& k) const {
    return {k.position.norm(), std::atan2(k.position.y(), k.position.x())};
  }
  Matrix<2, 2> jacobian(const Kinematics& k) const {
    const double squared = k.position.squaredNorm(), range = std::sqrt(squared);
    const double x = k.position.x(), y = k.position.y();
    Matrix<2, 2> h;
    h << x / range, y / range, -y / squared, x / squared;
    return h;
  }
  Vector<2> residual(const Vector<2>& z, const Vector<2>& e) const { return {z(0) - e(0), to_half_turn(z(1) - e(1))}; }
  bool sees(const Kinematics& k) const { return k.position.squaredNorm() >= kNearest * kNearest; }
};
static_assert(Model<RangeBearing>);

}  // namespace ttf::fusion::sensors
