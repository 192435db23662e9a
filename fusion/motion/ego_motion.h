// States describe the object's motion over ground, in the axes of the vehicle that carries the sensors. When
// the vehicle moves, state and covariance change their coordinates.
//
// The vehicle's new pose (t, yaw) is given in its old axes:
//   p <- R' (p - t),  v <- R' v,  a <- R' a,  heading <- heading - yaw,  P <- J P J' + G C G'
// J is the rotation of the layout, C the covariance of (t, yaw), G the derivative of the new state by (t, yaw).
// Turn rate, speed and acceleration along the heading stay.
#pragma once

#include <cmath>

#include "fusion/motion/kernels.h"
#include "fusion/motion/motion_model.h"

namespace ttf::fusion::motion {

// The vehicle's pose at the later instant, in its axes at the earlier instant.
struct PlanarMotion {
  linear::Vector<2> translation = linear::Vector<2>::Zero();  // [m]
  double yaw = 0.0;                                           // [rad]
  linear::Matrix<3> covariance = linear::Matrix<3>::Zero();   // for (x, y, yaw), the error of the odometry
};

template <Model M> void compensate(linear::Gaussian<M::kStates>& state, const PlanarMotion& ego) {
  constexpr int kN = M::kStates;
  const double c = std::cos(ego.yaw), s = std::sin(ego.yaw);
  linear::Matrix<2> back;  // R'
  back << c, s, -s, c;
  state.x.template head<2>() -= ego.translation;
  linear::Matrix<kN> j = linear::Matrix<kN>::Identity();
  constexpr int kVectors = M::kCartesian ? kN : 2;  // components that are vectors in the plane
  for (int i = 0; i < kVectors; i += 2) j.template block<2, 2>(i, i) = back;
  state.x = (j * state.x).eval();
  if constexpr (!M::kCartesian) state.x(M::kHeading) -= ego.yaw;
  M::normalise(state.x);

  linear::Matrix<kN, 3> g = linear::Matrix<kN, 3>::Zero();
  g.template topLeftCorner<2, 2>() = -back;
  for (int i = 0; i < kVectors; i += 2) {  // d (R' a) / d yaw = (y, -x) of the rotated vector
    g(i, 2) = state.x(i + 1);
    g(i + 1, 2) = -state.x(i);
  }
  if constexpr (!M::kCartesian) g(M::kHeading, 2) = -1.0;
  state.p = sandwich<kN, kN>(j, state.p);
  add_scaled<kN, kN>(state.p, 1.0, sandwich<kN, 3>(g, ego.covariance));
}

}  // namespace ttf::fusion::motion
