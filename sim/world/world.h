// The truth: objects that drive through the scene.
//
// An object's trajectory is a list of segments of constant acceleration and yaw rate, to which white process noise is
// added; it is drawn once on a 10 ms grid, with exact motion (constant acceleration, constant turn rate) within each
// step, so that looking at it any number of times, in any order, gives the same states.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/strict_yaml.h"
#include "core/time.h"

namespace ttf::sim::world {

// Centre [m], heading [rad] from x to y, speed [m/s] along it, acceleration [m/s^2] along it, yaw rate [rad/s], size
// [m].
struct ObjectState {
  ObjectId id{};
  double x = 0, y = 0, heading = 0, speed = 0, acceleration = 0, yaw_rate = 0, length = 0, width = 0;
};

struct TrajectorySegment {
  Duration duration{};
  double acceleration = 0;  // [m/s^2]
  double yaw_rate = 0;      // [rad/s]
};

struct ObjectConfig {
  std::string name;
  double x = 0, y = 0, heading = 0, speed = 0;  // at the start of the drive
  double length = 4.39, width = 1.79;           // a Volkswagen Touran, the paper's car
  std::vector<TrajectorySegment> segments;      // after the last one: straight on at constant speed
  bool reference = false;                       // carries the DGPS antenna
};

struct WorldConfig {
  // Those of the file's `objects`, then those of its `field`: of them all the first `object_count`, if it says so.
  std::vector<ObjectConfig> objects;
  // Standard deviations of the acceleration [m/s^2] and yaw rate [rad/s] added in each 10 ms step.
  double acceleration_noise = 0.0;
  double yaw_rate_noise = 0.0;
  Duration duration{};
};
WorldConfig load_world(YamlMap& yaml);

// `field`: equal objects in rows across the x axis, so many that nobody wants to name them. The first row is at
// `nearest`, the next ones `row` behind each other; within a row they are `across` apart, every other row by half of
// that to the side, as far as `half_angle` on either side of the x axis. Rows are filled one after the other, each from
// its middle.
struct FieldConfig {
  int objects = 0;
  double nearest = 40.0, row = 6.0, across = 4.0;  // [m]
  double half_angle = 0.7;                         // [rad]
  ObjectConfig each;                               // all but where it is
};
inline constexpr double kFarthest_m = 500.0;  // that an object may be from either axis
// As many as there is room for.
std::vector<ObjectConfig> placed(const FieldConfig& field);

// After `dt` >= 0 seconds of constant acceleration and yaw rate; a car that has come to a stop stays there.
ObjectState moved(const ObjectState& state, double dt);

class World {
 public:
  World(const WorldConfig& config, std::uint64_t seed, std::uint32_t replication);

  // All objects at `since_start` (time zero is the start of the drive; before it: as at the start; after its end:
  // the last step's motion goes on).
  void states_at(TrueTime since_start, std::vector<ObjectState>& out) const;
  ObjectState state_of(ObjectId object, TrueTime since_start) const;
  std::size_t size() const { return trajectories_.size(); }

 private:
  std::vector<std::vector<ObjectState>> trajectories_;  // per object, a state per grid step
};

}  // namespace ttf::sim::world
