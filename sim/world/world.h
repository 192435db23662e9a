// The truth: objects that drive through the scene, and the vehicle that carries the sensors.
//
// An object's trajectory is a list of segments of constant acceleration and yaw rate, with process noise added: white
// acceleration, or a speed that returns to the segments' (speed.h). It is drawn once on a 10 ms grid, with exact motion
// (constant acceleration, constant turn rate) within each step. So any number of looks, in any order, gives the same
// states. An object's size may be drawn, too (size.h).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/strict_yaml.h"
#include "core/time.h"
#include "sim/world/ego.h"
#include "sim/world/road/road.h"
#include "sim/world/size.h"
#include "sim/world/traffic/classes.h"
#include "sim/world/traffic/lane_driver.h"
#include "sim/world/traffic/lights.h"
#include "sim/world/vehicle/driven.h"
#include "sim/world/vehicle/journey.h"

namespace ttf::sim::world {

// Centre [m], heading [rad] from x to y, speed [m/s] along it, acceleration [m/s^2] along it, yaw rate [rad/s],
// size [m]. Centre and heading are in the axes of the sensors' vehicle at that instant. Speed, acceleration and yaw rate are
// over ground where the vehicle is an `ego`. Where it has an `own_speed`, the speed is relative to it, so that an object which
// falls back has a negative one.
// The acceleration contains the noise of its step. White noise has no value at an instant, only a density. An observer can
// have `steady`: the segments' acceleration, and the return of a speed with a memory (speed.h).
struct ObjectState {
  ObjectId id{};
  double x = 0, y = 0, heading = 0, speed = 0, acceleration = 0, yaw_rate = 0, length = 0, width = 0;
  double steady = 0;                            // [m/s^2] along the heading: the acceleration without white noise
  double height = traffic::kClasses[0].height;  // [m]
  double cross_section = traffic::kClasses[0].cross_section;  // [m^2], for a radar
  traffic::ObjectClass kind = traffic::ObjectClass::kCar;
};

struct TrajectorySegment {
  Duration duration{};
  double acceleration = 0;  // [m/s^2]
  double yaw_rate = 0;      // [rad/s]
  // [m/s], to be reached by an acceleration of that size, of either sign.
  std::optional<double> speed;
};

struct ObjectConfig {
  std::string name;
  double x = 0, y = 0, heading = 0, speed = 0;  // at the start of the drive; the speed is over ground
  double length = 4.39, width = 1.79;           // a Volkswagen Touran, the paper's car
  SizeConfig size;                              // whether this size or a drawn one is the object's
  std::vector<TrajectorySegment> segments;      // after the last one: straight on at constant speed
  // The lane on which it drives, instead of x, y, heading and segments.
  std::optional<traffic::LaneConfig> on;
  traffic::ObjectClass kind = traffic::ObjectClass::kCar;
  double height = traffic::kClasses[0].height, cross_section = traffic::kClasses[0].cross_section;
  bool reference = false;  // carries the DGPS antenna
};

struct WorldConfig {
  // The file's `objects`, then those of its `field`; only the first `object_count` of them all, if it is given.
  std::vector<ObjectConfig> objects;
  // Standard deviations of the acceleration [m/s^2] and yaw rate [rad/s] that are added in each 10 ms step.
  double acceleration_noise = 0.0;
  double yaw_rate_noise = 0.0;
  // Zero: the speed adds the noise up. Else it returns to that of the segments, and forgets deviations with this time
  // constant (speed.h).
  Duration speed_memory{};
  // The sensors' vehicle drives straight along x at this speed over ground [m/s]. If it is not zero, all objects keep
  // to the direction of x.
  double own_speed = 0.0;
  // The sensors' vehicle drives as this says, or as commands say. Without it, it stands at the origin, or has an `own_speed`.
  // Objects that follow do not see a vehicle that commands drive: their ways are drawn before it starts.
  std::optional<vehicle::EgoConfig> ego;
  std::optional<road::RoadConfig> road;
  std::vector<traffic::LightConfig> lights;
  Duration duration{};
};
WorldConfig load_world(YamlMap& yaml);

// `field`: equal objects in rows across the x axis, too many to name. The first row is at `nearest`, and rows are
// `row` apart. Objects in a row are `across` apart; every other row is shifted sideways by half of that. A row
// reaches to `half_angle` on either side of the x axis. Rows are filled one after the other, each from its middle.
struct FieldConfig {
  int objects = 0;
  double nearest = 40.0, row = 6.0, across = 4.0;  // [m]
  double half_angle = 0.7;                         // [rad]
  ObjectConfig each;                               // all but its place
};
inline constexpr double kFarthest_m = 500.0;  // the largest distance of an object from either axis
// Returns the objects of the field, as many as there is room for.
std::vector<ObjectConfig> placed(const FieldConfig& field);

// Returns the state after `dt` >= 0 seconds of constant acceleration and yaw rate; a car that has stopped stays there.
ObjectState moved(const ObjectState& state, double dt);

class World {
 public:
  World(const WorldConfig& config, std::uint64_t seed, std::uint32_t replication);

  // Returns all objects at `since_start`, where time zero is the start of the drive. Earlier states are those
  // at the start; after the drive's end the last step's motion goes on.
  void states_at(TrueTime since_start, std::vector<ObjectState>& out) const;
  ObjectState state_of(ObjectId object, TrueTime since_start) const;
  // Returns the state of the sensors' vehicle: without an `ego`, one that stands at the origin.
  EgoState ego_at(TrueTime since_start) const;
  // Returns the vehicle that commands drive; null, if the world has none.
  vehicle::Driven* driven() const { return driven_.get(); }
  // Returns the road, over ground; null in a world without one.
  const road::Road* road() const { return road_ ? &*road_ : nullptr; }
  std::span<const traffic::LightConfig> lights() const { return lights_; }
  std::size_t size() const { return trajectories_.size(); }

 private:
  ObjectState over_ground(ObjectId object, TrueTime since_start) const;
  void drive_on_lanes(const WorldConfig& config, std::uint64_t seed, std::uint32_t replication, std::size_t steps);

  double own_speed_ = 0.0;
  std::optional<road::Road> road_;
  std::vector<traffic::LightConfig> lights_;
  std::optional<vehicle::Journey> ego_;
  std::unique_ptr<vehicle::Driven> driven_;             // instead of ego_; a look makes it go on
  std::vector<std::vector<ObjectState>> trajectories_;  // over ground: per object, a state per grid step
};

}  // namespace ttf::sim::world
