// The constant-velocity model has the state (x, y, vx, vy). White acceleration of spectral density q [m^2/s^3]
// drives each axis. Bar-Shalom, Li, Kirubarajan: "Estimation with Applications to Tracking and Navigation",
// 2001, eq. 6.2.2-8.
#pragma once

#include "fusion/motion/integrator_chain.h"

namespace ttf::fusion::motion {

struct ConstantVelocity : IntegratorChain<2> {
  static constexpr const char* kName = "ConstantVelocity";
  explicit ConstantVelocity(double q = 1.0) : ConstantVelocity(q, q) {}
  ConstantVelocity(double along_x, double along_y) {
    spectral_density = along_x;
    cross_density = along_y;
  }
};
static_assert(StructuredModel<ConstantVelocity>);

}  // namespace ttf::fusion::motion
