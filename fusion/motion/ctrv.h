// The constant turn rate and velocity model (CTRV) has the state (x, y, heading, speed, turn rate). The noise is white
// turn acceleration [rad^2/s^3] and white acceleration along the heading [m^2/s^3].
#pragma once

#include "fusion/motion/coordinated_turn.h"

namespace ttf::fusion::motion {

struct Ctrv : CoordinatedTurn<5> {
  static constexpr const char* kName = "Ctrv";
  explicit Ctrv(double turn_acceleration = 1.0, double acceleration = 1.0) {
    turn_density = turn_acceleration;
    along_density = acceleration;
  }
};
static_assert(Model<Ctrv>);

}  // namespace ttf::fusion::motion
