// The kinematics are position, velocity and heading of an object in the plane. Axes are those of ISO 8855 (x
// forward, y left, heading from x to y), units metres, seconds and radians. Sensor models measure only these
// five numbers, and motion models derive them from their state. So every sensor works with every motion model.
#pragma once

#include "fusion/linear/gaussian.h"

namespace ttf::fusion::motion {

struct Kinematics {
  linear::Vector<2> position = linear::Vector<2>::Zero();  // [m]
  linear::Vector<2> velocity = linear::Vector<2>::Zero();  // [m/s]
  double heading = 0.0;                                    // [rad]
  bool has_heading = false;                                // false for a slow object whose heading is only its course
};

// The number of wanted components of (x, y, vx, vy, heading); the others need not be computed.
inline constexpr int kPositionOnly = 2, kWithVelocity = 4, kWithHeading = 5;

// Returns the number of state columns that the wanted components depend on. All layouts begin with the
// position, and their first four components determine all kinematics. A measurement matrix is [H 0], and H has
// that many columns.
constexpr int leading_columns(int parts) { return parts == kPositionOnly ? 2 : 4; }

}  // namespace ttf::fusion::motion
