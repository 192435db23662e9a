// Angles in radians; a difference of angles is at most half a turn.
#pragma once

#include <cmath>
#include <numbers>

namespace ttf::fusion::motion {

// Maps an angle to [-pi, pi]; an angle already in that interval keeps its bits.
inline double to_half_turn(double angle) {
  constexpr double kPi = std::numbers::pi;
  return std::abs(angle) <= kPi ? angle : std::remainder(angle, 2.0 * kPi);
}

}  // namespace ttf::fusion::motion
