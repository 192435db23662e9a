// The state of the vehicle that carries the sensors. Its axes have their origin in the middle of the rear axle, x forward
// and y left (ISO 8855). All sensors' places and all objects' states are given in these axes.
#pragma once

namespace ttf::sim::world {

// The pose is over ground. Velocities are over ground, too, but along the vehicle's own axes.
struct EgoState {
  double x = 0.0, y = 0.0;    // [m]
  double heading = 0.0;       // [rad], from the ground's x axis to the vehicle's
  double vx = 0.0, vy = 0.0;  // [m/s], of the origin: vy is the slip of the rear axle, zero for a kinematic vehicle
  double yaw_rate = 0.0;      // [rad/s]
  double acceleration = 0.0;  // [m/s^2], along x
};

}  // namespace ttf::sim::world
