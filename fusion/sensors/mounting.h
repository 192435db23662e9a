// Where a sensor is on its vehicle, and where it stands in the axes of the tracks. These are the vehicle's axes, or the
// odometry frame if the vehicle moves (fusion/ego/ego_path.h). There the vehicle itself has a place, too.
#pragma once

#include <cmath>

#include "fusion/linear/gaussian.h"

namespace ttf::fusion::sensors {

struct Mounting {
  linear::Vector<2> position = linear::Vector<2>::Zero();  // [m]
  double yaw = 0.0;                                        // [rad] from the x axis to the sensor's
  double yaw_rate = 0.0;                                   // [rad/s], zero on a standing vehicle
  linear::Vector<2> velocity = linear::Vector<2>::Zero();  // [m/s] over ground, zero on a standing vehicle
};

// Returns whether observations are in the sensor's own axes, and the sensor stands still.
inline bool at_the_origin(const Mounting& mounting) {
  return mounting.position.x() == 0.0 && mounting.position.y() == 0.0 && mounting.yaw == 0.0 &&
         mounting.yaw_rate == 0.0 && mounting.velocity.x() == 0.0 && mounting.velocity.y() == 0.0;
}

// Returns the mounting on a moving vehicle, from the velocity of its origin over ground, in its own axes, and
// its yaw rate [rad/s].
inline Mounting carried(Mounting mounting, const linear::Vector<2>& velocity, double yaw_rate) {
  mounting.velocity = velocity + yaw_rate * linear::Vector<2>(-mounting.position.y(), mounting.position.x());
  mounting.yaw_rate = yaw_rate;
  return mounting;
}

inline linear::Vector<2> turned(const linear::Vector<2>& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

// Returns the place of a sensor with this mounting, in the axes in which its vehicle has the place `vehicle`.
inline Mounting placed_on(const Mounting& vehicle, const Mounting& mounting) {
  const linear::Vector<2> lever = turned(mounting.position, vehicle.yaw);
  Mounting sensor;
  sensor.position = vehicle.position + lever;
  sensor.yaw = vehicle.yaw + mounting.yaw;
  sensor.yaw_rate = vehicle.yaw_rate;
  sensor.velocity = vehicle.velocity + vehicle.yaw_rate * linear::Vector<2>(-lever.y(), lever.x());
  return sensor;
}

}  // namespace ttf::fusion::sensors
