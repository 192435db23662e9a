// Time to collision of two vehicles in a line, and the braking that avoids it.
#pragma once

namespace ttf::nodes::control {

// Returns the clearance [m] over the closing speed [m/s], in seconds, for constant speeds (ISO 15623). It is 0 without clearance,
// and infinite if the clearance does not shrink.
double time_to_collision(double clearance, double closing_speed);

struct InLine {
  double speed = 0.0;         // [m/s], not negative
  double acceleration = 0.0;  // [m/s^2]
};
// Returns the first instant [s] without clearance for constant accelerations; infinite if there is none. A vehicle that brakes
// stops, and stays there.
double time_to_collision(double clearance, const InLine& own, const InLine& ahead);

// Returns the least constant deceleration [m/s^2] with which the own vehicle does not touch the one ahead. The latter keeps its
// acceleration, and stops if it is negative. 0 if no braking is needed, infinite without clearance.
double needed_deceleration(double clearance, double own_speed, const InLine& ahead);

}  // namespace ttf::nodes::control
