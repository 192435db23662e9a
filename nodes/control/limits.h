// Limits of acceleration and jerk, and the step of a command within them.
//
// An adaptive cruise control's limits depend on the speed: they are constant at 5 m/s and below, and at 20 m/s and
// above, and linear between. The defaults are ISO 15622's as they are commonly cited. The standard limits averages over
// 1 to 2 s; here each instant is limited. Accelerations are positive forwards.
#pragma once

namespace ttf::nodes::control {

struct Limits {
  double acceleration = 2.0;  // [m/s^2], the largest
  double deceleration = 3.5;  // [m/s^2], likewise, positive
  double jerk = 2.5;          // [m/s^3], to either side; infinite: no limit
};

// Limits at slow and at fast speeds.
struct LimitsBySpeed {
  double slow_mps = 5.0, fast_mps = 20.0;
  Limits slow{2.0, 5.0, 5.0};
  Limits fast{2.0, 3.5, 2.5};
};
// Returns the limits at a speed [m/s].
Limits at_speed(const LimitsBySpeed& limits, double speed);

// Returns the acceleration [m/s^2] nearest to `wanted` within the limits, at most jerk * dt [s] from `before`. Where the limits
// have become narrower than `before`, the way back obeys the jerk, too.
double limited(const Limits& limits, double wanted, double before, double dt);

}  // namespace ttf::nodes::control
