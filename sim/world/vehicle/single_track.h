// Single-track models of a vehicle: the two wheels of an axle are one.
//
// The kinematic model has no slip. For the rear axle's middle, with the steering angle d and the wheelbase l:
//   x' = v cos h,  y' = v sin h,  h' = v / l tan d.
// The dynamic model is for the centre of mass. Its tyres' forces are linear in their slip angles. They are proportional to the
// load, too, which an acceleration a shifts between the axles. With the yaw rate w and the slip b of the velocity:
//   x' = v cos(h + b),  y' = v sin(h + b),  h' = w,
//   w' = mu m / (I l) (-(lf^2 Ff + lr^2 Fr) w / v + (lr Fr - lf Ff) b + lf Ff d),
//   b' = mu / (v l) ((lr Fr - lf Ff) w / v - (Fr + Ff) b + Ff d) - w,   Ff = Cf (g lr - a h),  Fr = Cr (g lf + a h).
// The stiffnesses Cf and Cr are in 1/rad, for a unit of load.
//
// Equations, limits and defaults are those of Althoff and Wuersching: "CommonRoad: Vehicle Models" (2020), chapters 3, 5 and 7.
// The default vehicle is their first one, a Ford Escort.
//
// The dynamic model divides by the speed. So the vehicle is kinematic below `kinematic_below`. Slip and yaw rate follow from the
// steering angle there. A vehicle that slows down jumps to these values, which differ little by then.
//
// A step is one of Runge-Kutta's fourth order, of kStep_s. It is stable up to 2.78 v / (mu C g), which is 6 ms at 0.5 m/s, the
// slowest speed of the dynamic model. From 3 m/s on, positions differ by 1e-9 m a second from those with steps a tenth as long.
#pragma once

namespace ttf::sim::world::vehicle {

struct Parameters {
  double front_axle = 1.1561957064, rear_axle = 1.4227170936;  // [m], from the centre of mass
  double mass = 1093.2952334674046;                            // [kg]
  double yaw_inertia = 1791.5995300122856;                     // [kg m^2]
  double height = 0.61373004;                                  // [m], of the centre of mass
  double friction = 1.0489;
  double front_stiffness = 21.92 / 1.0489, rear_stiffness = 21.92 / 1.0489;  // [1/rad]
  double largest_steering = 1.066;                                           // [rad], to either side
  double largest_steering_rate = 0.4;                                        // [rad/s]
  double slowest = -13.6, fastest = 50.8;                                    // [m/s]
  // The engine's power limits the acceleration above a speed: to largest_acceleration * full_power_speed / v.
  double largest_acceleration = 11.5;  // [m/s^2], of engine and brakes
  double full_power_speed = 7.319;     // [m/s]
  double kinematic_below = 3.0;        // [m/s]; infinite: always

  double wheelbase() const { return front_axle + rear_axle; }
};

struct Command {
  double steering_rate = 0.0;  // [rad/s]
  double acceleration = 0.0;   // [m/s^2]
};

// The state of the rear axle's middle: [m], [rad], [m/s].
struct RearAxle {
  double x = 0.0, y = 0.0, steering = 0.0, speed = 0.0, heading = 0.0;
};

// The state of the centre of mass. The speed is along the velocity, which has the direction heading + slip.
struct Motion {
  double x = 0.0, y = 0.0, steering = 0.0, speed = 0.0, heading = 0.0, yaw_rate = 0.0, slip = 0.0;
};

// Returns what the vehicle can do of a command.
Command limited(const Parameters& vehicle, double steering, double speed, const Command& command);

// Return the states' time derivatives, by the kinematic and by the dynamic model. The command is limited.
RearAxle rates(const Parameters& vehicle, const RearAxle& state, const Command& command);
Motion rates(const Parameters& vehicle, const Motion& state, const Command& command);

// The rear axle of a vehicle that moves without slip, and back.
RearAxle rear_axle(const Parameters& vehicle, const Motion& state);
Motion without_slip(const Parameters& vehicle, const RearAxle& state);

inline constexpr double kStep_s = 0.002;
// Returns the state after one step of `dt` <= kStep_s, by the model of the state's speed.
Motion stepped(const Parameters& vehicle, const Motion& state, const Command& command, double dt);
// Returns the state after `seconds` >= 0 of one command: whole steps and a rest.
Motion advanced(const Parameters& vehicle, Motion state, const Command& command, double seconds);

// Returns the steering angle with which the vehicle keeps the yaw rate [rad/s] at its speed, as far as it steers.
double steering_for(const Parameters& vehicle, double yaw_rate, const Motion& state);

}  // namespace ttf::sim::world::vehicle
