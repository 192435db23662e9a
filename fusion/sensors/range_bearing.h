// z = (range, bearing) [m, rad], the bearing from the x axis to the y axis.
#pragma once

#include <cmath>

#include "fusion/motion/angles.h"
#include "fusion/sensors/sensor_model.h"

namespace ttf::fusion::sensors {

// Below this distance [m] an object has no bearing.
inline constexpr double kNearest = 1e-3;

struct RangeBearing {
  static constexpr const char* kName = "RangeBearing";
  static constexpr int kDimension = 2, kParts = motion::kPositionOnly;
  static constexpr bool kLinear = false;

  linear::Vector<2> expected(const motion::Kinematics& k) const {
    return {k.position.norm(), std::atan2(k.position.y(), k.position.x())};
  }
  linear::Matrix<2, 2> jacobian(const motion::Kinematics& k) const {
    const double squared = k.position.squaredNorm(), range = std::sqrt(squared);
    const double x = k.position.x(), y = k.position.y();
    linear::Matrix<2, 2> h;
    h << x / range, y / range, -y / squared, x / squared;
    return h;
  }
  linear::Vector<2> residual(const linear::Vector<2>& z, const linear::Vector<2>& e) const {
    return {z(0) - e(0), motion::to_half_turn(z(1) - e(1))};
  }
  bool sees(const motion::Kinematics& k) const { return k.position.squaredNorm() >= kNearest * kNearest; }
};
static_assert(Model<RangeBearing>);

}  // namespace ttf::fusion::sensors
