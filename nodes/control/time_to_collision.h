// Time to collision of two vehicles in a line.
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

}  // namespace ttf::nodes::control
