// A sensor in a scene, in plain terms. Coordinates follow ISO 8855: metres and radians.
#pragma once

#include <optional>
#include <string>

namespace ttf::recording::scene {

struct Point {
  double x = 0.0, y = 0.0;  // [m]
};
struct Pose {
  double x = 0.0, y = 0.0, heading = 0.0;  // [m], [rad] from x to y
};

// How the sensors' vehicle drives over ground: the speed of its origin along x, and its yaw rate.
struct OwnMotion {
  double speed = 0.0, yaw_rate = 0.0;  // [m/s], [rad/s]
};

// The part of the plane that a sensor sees, in its own axes.
struct ViewedField {
  double half_angle = 0.0;                    // [rad] to either side of the sensor's axis
  double min_range = 0.0, max_range = 100.0;  // [m]
};
struct ViewedSensor {
  std::string name;
  std::string colour;                // "#d55e00"
  std::optional<Pose> mounting;      // on the vehicle; absent: unknown
  std::optional<ViewedField> field;  // absent: unknown
  bool odometry = false;             // it measures its own vehicle, and sees no objects
};

}  // namespace ttf::recording::scene
