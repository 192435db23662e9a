// The constant-acceleration model has the state (x, y, vx, vy, ax, ay). White jerk of spectral density q
// [m^2/s^5] drives each axis. Bar-Shalom, Li, Kirubarajan: "Estimation with Applications to Tracking and
// Navigation", 2001, eq. 6.2.3-7.
#pragma once

#include "fusion/motion/integrator_chain.h"

namespace ttf::fusion::motion {

struct ConstantAcceleration : IntegratorChain<3> {
  static constexpr const char* kName = "ConstantAcceleration";
  explicit ConstantAcceleration(double q = 1.0) : ConstantAcceleration(q, q) {}
  ConstantAcceleration(double along_x, double along_y) {
    spectral_density = along_x;
    cross_density = along_y;
  }
};
static_assert(StructuredModel<ConstantAcceleration>);

}  // namespace ttf::fusion::motion
