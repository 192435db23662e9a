// The Stanley controller of a vehicle along a path, at the front axle.
//
//   delta = a + psi_ss + atan2(k e, k_soft + v) + k_yaw (r_path - r) + k_steer (delta_before - delta_now)
// a is the path's direction less the vehicle's heading, e the path's offset to the left of the front axle's middle, r the yaw rate.
// psi_ss lets a vehicle whose tyres slip drive a circle without offset: for the front axle's slip angle F / C,
//   psi_ss = m v r_path / (C (1 + lf / lr)).
//
// Hoffmann, Tomlin, Montemerlo, Thrun: "Autonomous automobile trajectory tracking for off-road driving" (2007), equation 9; the
// signs here are those of ISO 8855, so that a positive angle turns to the left. PythonRobotics has the first and the third term
// alone, with k 0.5, k_soft 0 and 30 degrees.
#pragma once

namespace ttf::nodes::control {

struct StanleyGains {
  double offset = 2.5;                // k [1/s]
  double softening_mps = 1.0;         // k_soft
  double yaw_rate_s = 0.1;            // k_yaw
  double steering = 0.1;              // k_steer
  double largest_rad = 0.6108652382;  // 35 degrees, to either side
};

struct StanleyInput {
  double direction_error = 0.0;                      // [rad]
  double offset = 0.0;                               // [m]
  double speed = 0.0;                                // [m/s], not negative
  double yaw_rate = 0.0, path_yaw_rate = 0.0;        // [rad/s]
  double steering_before = 0.0, steering_now = 0.0;  // [rad], as measured
  double steady_slip = 0.0;                          // psi_ss [rad]
};

// Returns the steering angle [rad].
double stanley_steering(const StanleyGains& gains, const StanleyInput& input);

struct AxleLoad {
  double mass = 2000.0;                      // [kg]
  double front_axle = 1.4, rear_axle = 1.6;  // [m], from the centre of mass
  double front_stiffness = 24e3;             // [N/rad], of the axle: of both tyres
};
// Returns psi_ss [rad] at a speed [m/s] and the path's yaw rate [rad/s].
double steady_slip(const AxleLoad& load, double speed, double path_yaw_rate);

}  // namespace ttf::nodes::control
