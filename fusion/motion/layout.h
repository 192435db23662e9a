// A layout names the components of a state and derives its kinematics. There are two layouts:
//   Cartesian<4>  (x, y, vx, vy)                      Cartesian<6>  (x, y, vx, vy, ax, ay)
//   Polar<5>      (x, y, heading, speed, turn rate)   Polar<6>      (..., acceleration along the heading)
// The heading of a Cartesian state is its course, the direction of its velocity. The heading of a polar state
// is the direction of the object's front; its speed is negative in reverse.
#pragma once

#include <array>
#include <cmath>

#include "fusion/motion/angles.h"
#include "fusion/motion/kinematics.h"

namespace ttf::fusion::motion {

// Below this speed [m/s] a course gives no heading.
inline constexpr double kSlowest = 0.1;

template <int N> struct Cartesian {
  static_assert(N == 4 || N == 6);
  static constexpr int kStates = N;
  static constexpr bool kCartesian = true;

  static linear::Vector<N> difference(const linear::Vector<N>& a, const linear::Vector<N>& b) { return a - b; }
  static void normalise(linear::Vector<N>&) {}

  template <int Parts> static Kinematics kinematics(const linear::Vector<N>& x) {
    Kinematics k{.position = x.template head<2>(), .velocity = x.template segment<2>(2)};
    if constexpr (Parts == kWithHeading) {
      k.has_heading = k.velocity.squaredNorm() >= kSlowest * kSlowest;
      if (k.has_heading) k.heading = std::atan2(x(3), x(2));
    }
    return k;
  }

  // d (x, y, vx, vy, heading) / d (the first four components).
  static linear::Matrix<5, 4> kinematics_jacobian(const linear::Vector<N>& x) {
    linear::Matrix<5, 4> j = linear::Matrix<5, 4>::Identity();
    const double squared = x.template segment<2>(2).squaredNorm();
    if (squared >= kSlowest * kSlowest) {
      j(4, 2) = -x(3) / squared;
      j(4, 3) = x(2) / squared;
    }
    return j;
  }
};

template <int N> struct Polar {
  static_assert(N == 5 || N == 6);
  static constexpr int kStates = N;
  static constexpr bool kCartesian = false;
  static constexpr int kHeading = 2, kSpeed = 3, kTurnRate = 4, kAcceleration = 5;

  static linear::Vector<N> difference(const linear::Vector<N>& a, const linear::Vector<N>& b) {
    linear::Vector<N> d = a - b;
    d(kHeading) = to_half_turn(d(kHeading));
    return d;
  }
  static void normalise(linear::Vector<N>& x) { x(kHeading) = to_half_turn(x(kHeading)); }

  template <int Parts> static Kinematics kinematics(const linear::Vector<N>& x) {
    Kinematics k{.position = x.template head<2>()};
    if constexpr (Parts >= kWithVelocity)
      k.velocity = x(kSpeed) * linear::Vector<2>(std::cos(x(kHeading)), std::sin(x(kHeading)));
    k.heading = x(kHeading);
    k.has_heading = true;
    return k;
  }

  static linear::Matrix<5, 4> kinematics_jacobian(const linear::Vector<N>& x) {
    const double c = std::cos(x(kHeading)), s = std::sin(x(kHeading));
    linear::Matrix<5, 4> j = linear::Matrix<5, 4>::Zero();
    j(0, 0) = j(1, 1) = j(4, kHeading) = 1.0;
    j(2, kHeading) = -x(kSpeed) * s;
    j(3, kHeading) = x(kSpeed) * c;
    j(2, kSpeed) = c;
    j(3, kSpeed) = s;
    return j;
  }
};

}  // namespace ttf::fusion::motion
