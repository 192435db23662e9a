// Time to collision of two vehicles in a line, and the braking that avoids it.
#pragma once

namespace ttf::nodes::control {

// Returns clearance / closing speed [s] for constant speeds (ISO 15623): 0 without clearance, infinite if the clearance does not
// shrink.
double time_to_collision(double clearance, double closing_speed);

// A vehicle in the line: [m/s], not negative, and [m/s^2].
struct InLine {
  double speed = 0.0;
  double acceleration = 0.0;
};
// Returns the first instant [s] without clearance for constant accelerations. A vehicle that brakes stops, and stays there.
// Infinite without one.
double time_to_collision(double clearance, const InLine& own, const InLine& ahead);

// Returns the least constant deceleration [m/s^2] from now on with which the own vehicle does not touch the one ahead, which
// keeps its acceleration and stops if that is negative. 0 if no braking is needed, infinite without clearance.
double needed_deceleration(double clearance, double own_speed, const InLine& ahead);

}  // namespace ttf::nodes::control
