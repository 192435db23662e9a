// z = (range, bearing, range rate) [m, rad, m/s] of a radar. The range rate is the velocity relative to the
// sensor along the line of sight, positive for a receding object. A radar may measure it up to multiples of a span: then the
// residual is the nearest of all.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "fusion/motion/angles.h"
#include "fusion/sensors/range_bearing.h"

namespace ttf::fusion::sensors {

struct RangeBearingRate {
  static constexpr const char* kName = "RangeBearingRate";
  static constexpr int kDimension = 3, kParts = motion::kWithVelocity;
  static constexpr bool kLinear = false;

  double rate_span = std::numeric_limits<double>::infinity();  // [m/s]

  linear::Vector<3> expected(const motion::Kinematics& k) const {
    const double range = k.position.norm();
    return {range, std::atan2(k.position.y(), k.position.x()), k.position.dot(k.velocity) / std::max(range, kNearest)};
  }
  linear::Matrix<3, 4> jacobian(const motion::Kinematics& k) const {
    const double squared = k.position.squaredNorm(), range = std::sqrt(squared);
    const double c = k.position.x() / range, s = k.position.y() / range;
    const double across = (c * k.velocity.y() - s * k.velocity.x()) / range;  // turn rate of the line of sight
    linear::Matrix<3, 4> h;
    h << c, s, 0.0, 0.0, -s / range, c / range, 0.0, 0.0, -s * across, c * across, c, s;
    return h;
  }
  linear::Vector<3> residual(const linear::Vector<3>& z, const linear::Vector<3>& e) const {
    return {z(0) - e(0), motion::to_half_turn(z(1) - e(1)),
            std::isfinite(rate_span) ? std::remainder(z(2) - e(2), rate_span) : z(2) - e(2)};
  }
  bool sees(const motion::Kinematics& k) const { return k.position.squaredNorm() >= kNearest * kNearest; }
};
static_assert(Model<RangeBearingRate>);

}  // namespace ttf::fusion::sensors
