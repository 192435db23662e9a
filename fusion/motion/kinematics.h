// What sensors can see of an object, whatever its motion model keeps: position, velocity, heading in the plane.
// ISO 8855 (x forward, y left, heading from x to y), metres, seconds, radians. A sensor model is written over these
// five numbers, a motion model says how they follow from its state: every sensor takes every motion model.
#pragma once

#include "fusion/linear/gaussian.h"

namespace ttf::fusion::motion {

struct Kinematics {
  linear::Vector<2> position = linear::Vector<2>::Zero();  // [m]
  linear::Vector<2> velocity = linear::Vector<2>::Zero();  // [m/s]
  double heading = 0.0;                                    // [rad]
  bool has_heading = false;  // not of something slow whose heading is only known as its course
};

// How many of (x, y, vx, vy, heading) are asked for: what is not asked for need not be computed.
inline constexpr int kPositionOnly = 2, kWithVelocity = 4, kWithHeading = 5;

// Columns of the state that these depend on. All layouts begin with the position, and their first four components carry
// all of the kinematics: a measurement matrix is [H 0] with H of so many columns.
constexpr int leading_columns(int parts) { return parts == kPositionOnly ? 2 : 4; }

}  // namespace ttf::fusion::motion
