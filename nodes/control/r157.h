// A figure of UN Regulation 157 (automated lane keeping): the minimum following distance. It judges a drive and steers none.
//
// It is that of the regulation, and of esmini's controllers for it (ControllerALKS_R157SM, 3.6.0).
#pragma once

namespace ttf::nodes::control {

// Returns the minimum following distance [m] at a speed [m/s]: the speed times a time gap of
//   1 + (max(2, v) - 2) / 7.8  below 10 km/h,  1 + v / (100 km/h)  above,
// at least 2 m.
double minimum_following_distance(double speed);

}  // namespace ttf::nodes::control
