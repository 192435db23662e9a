// The way of the vehicle that carries the sensors: a single-track model that is driven through given segments.
//
// A segment says an acceleration, or a speed to reach by it. It says how the vehicle steers, too: by an angle, by a yaw rate, or
// along a lane of the road. The steering takes its time, so that a yaw rate is there a little late. Without a word on steering the
// vehicle follows the lane that it is on, or drives straight on. After the last segment it does so at constant speed. It never
// drives backwards: braking ends in a standstill.
//
// On a lane the way of the rear axle has the lane's curvature and a correction. For the angle a and the distance e between the two
// ways, the correction is
//   -2 a / L - e / L^2.
// Errors then fade as exp(-way / L), without overshoot.
//
// The way is drawn once on the world's grid of 10 ms, with a constant command within each step. Any instant between is a few
// steps of the model away. So any number of looks, in any order, gives the same states.
#pragma once

#include <optional>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "sim/world/road/road.h"
#include "sim/world/traffic/pace.h"
#include "sim/world/vehicle/actuator.h"
#include "sim/world/vehicle/single_track.h"

namespace ttf::sim::world::vehicle {

struct Segment {
  Duration duration{};
  traffic::Pace pace;
  // One of them, or none.
  std::optional<double> steering;                  // [rad]
  std::optional<double> yaw_rate;                  // [rad/s]
  std::optional<int> lane;                         // to be followed, and to be changed to
  Duration within = Duration::milliseconds(3000);  // the change
};

struct EgoConfig {
  Parameters vehicle;
  double x = 0.0, y = 0.0, heading = 0.0, speed = 0.0;  // at the start: middle of the rear axle, over ground
  std::optional<road::OnLane> on;                       // instead of x, y and heading
  std::vector<Segment> segments;
  // Commands on the bus drive the vehicle, instead of the segments (driven.h).
  std::optional<ActuatorConfig> actuator;
  int actuator_line = 0;  // in the file
  // The front bumper is this far ahead of the rear axle: wheelbase and overhang of a passenger car [m].
  double front = 3.4, width = 1.8;
};
// `road` is null in a world without one.
EgoConfig load_ego(YamlMap& yaml, const road::RoadConfig* road);

// The state of the rear axle's middle: over ground, velocities along the vehicle's axes.
struct RearAxleMotion {
  double x = 0.0, y = 0.0, heading = 0.0, vx = 0.0, vy = 0.0, yaw_rate = 0.0, acceleration = 0.0;
};

// Returns the motion at the start.
Motion start_of(const EgoConfig& config, const road::Road* road);
// Returns the motion of the rear axle while a command holds.
RearAxleMotion rear_axle_motion(const Parameters& vehicle, const Motion& now, const Command& command);

class Journey {
 public:
  // `road` may be null where no lane is followed, and need not outlive the constructor.
  Journey(const EgoConfig& config, const road::Road* road, Duration duration);
  // Earlier states are those at the start; after the end the last command goes on.
  RearAxleMotion at(TrueTime since_start) const;

 private:
  struct Step {
    Motion motion;
    Command command;
  };
  Parameters vehicle_;
  std::vector<Step> steps_;
};

}  // namespace ttf::sim::world::vehicle
