// The constant turn rate and acceleration model (CTRA) has the state (x, y, heading, speed, turn rate,
// acceleration along the heading). The noise is white turn acceleration [rad^2/s^3] and white jerk along the
// heading [m^2/s^5].
#pragma once

#include "fusion/motion/coordinated_turn.h"

namespace ttf::fusion::motion {

struct Ctra : CoordinatedTurn<6> {
  static constexpr const char* kName = "Ctra";
  explicit Ctra(double turn_acceleration = 1.0, double jerk = 1.0) {
    turn_density = turn_acceleration;
    along_density = jerk;
  }
};
static_assert(Model<Ctra>);

}  // namespace ttf::fusion::motion
