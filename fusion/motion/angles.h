// Angles in radians: differences belong to the nearest turn.
#pragma once

#include <cmath>
#include <numbers>

namespace ttf::fusion::motion {

// To [-pi, pi]; what lies there already keeps its bits.
inline double to_half_turn(double angle) {
  constexpr double kPi = std::numbers::pi;
  return std::abs(angle) <= kPi ? angle : std::remainder(angle, 2.0 * kPi);
}

// To [-pi/2, pi/2]: of a direction whose front and back cannot be told apart.
inline double to_quarter_turn(double angle) {
  constexpr double kPi = std::numbers::pi;
  return std::abs(angle) <= 0.5 * kPi ? angle : std::remainder(angle, kPi);
}

}  // namespace ttf::fusion::motion
