// A transition at constant velocity, and measured positions, for both forms (axes.h, joint.h).
#pragma once

#include "fusion/batch/lanes.h"
#include "fusion/motion/constant_velocity.h"

namespace ttf::fusion::batch {

// A transition by dt >= 0 seconds: x += dt v, and the covariance of (position, velocity) that white
// acceleration adds per axis.
struct Step {
  double dt = 0.0;
  double q_xx = 0.0, q_xv = 0.0, q_vv = 0.0;

  Step() = default;
  Step(const motion::ConstantVelocity& model, double by) : dt(by) {
    const linear::Matrix<4> q = model.noise(linear::Vector<4>::Zero(), by);
    q_xx = q(0, 0), q_xv = q(0, 2), q_vv = q(2, 2);
  }
};

// z = (x, y) [m] with the covariance of its noise, which is positive definite even in unseen lanes, where it is
// unused.
template <class V> struct Position {
  V x{}, y{};
  V r_xx{}, r_xy{}, r_yy{};
  typename MaskOf<V>::Type seen{};
};

}  // namespace ttf::fusion::batch
