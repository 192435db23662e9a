// An object that drives on the lanes of a road.
//
// It keeps to its lane's middle, or changes to another lane (road/lane_change.h). Manoeuvres say its acceleration, or a speed to
// reach. Its speed is that along its way. Without a word on either, and after the last manoeuvre, it keeps its speed. Or it follows
// the object ahead by the intelligent driver model:
//   a' = a (1 - (v / v0)^4 - (s* / s)^2),   s* = s0 + max(0, v T + v (v - v_ahead) / (2 sqrt(a b))).
// There s is the gap between the two, v0 the wanted speed, T the time gap, and s0 the smallest gap. The usual acceleration is a,
// the usual deceleration b. Source: Treiber, Hennecke, Helbing: "Congested traffic states in empirical observations and
// microscopic simulations", Physical Review E 62 (2000).
//
// A slow object changes lanes more slowly: it moves sideways by half of its speed at most.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "sim/world/road/lane_change.h"
#include "sim/world/road/road.h"
#include "sim/world/traffic/pace.h"

namespace ttf::sim::world::traffic {

struct Manoeuvre {
  Duration duration{};
  Pace pace;
  std::optional<int> lane;  // to be changed to from the segment's beginning on
  Duration within = Duration::milliseconds(3000);
};

struct Follow {
  double speed = 13.9;                            // [m/s], wanted
  double time_gap = 1.5;                          // [s]
  double smallest_gap = 2.0;                      // [m]
  double acceleration = 1.0, deceleration = 1.5;  // [m/s^2]
};

struct LaneConfig {
  road::OnLane start;
  std::vector<Manoeuvre> manoeuvres;
  std::optional<Follow> follow;
};
// Reads the object's `manoeuvres` and `follow`, and its start from `at`.
LaneConfig load_lane_config(YamlMap& object, YamlMap& on, const road::RoadConfig& road);

// The acceleration by which `follow` drives at `speed`, with another `gap` ahead that drives at `ahead`.
double following(const Follow& follow, double speed, double gap, double ahead);

// Another vehicle as a driver sees it, or a light that stops the driver.
struct Vehicle {
  road::LinePlace place;
  double direction = 1.0;  // along the line or against it
  double speed = 0.0, length = 0.0, width = 0.0;
};

class LaneDriver {
 public:
  LaneDriver(const LaneConfig& config, const road::Road& road, double speed);

  const road::LinePlace& place() const { return place_; }
  double speed() const { return speed_; }
  double direction() const { return direction_; }
  // The centre, and the direction in which it moves or, standing, last moved.
  road::Pose pose() const;

  // Begins what the manoeuvres say for `now`, and returns the wanted acceleration. `others` has the object itself at `self`.
  double wanted(Duration now, std::span<const Vehicle> others, std::size_t self);
  // Drives on for `seconds`; it does not drive backwards.
  void advance(double acceleration, double seconds);

 private:
  LaneConfig config_;
  const road::Road* road_;
  road::LinePlace place_;
  road::LaneChange change_;
  double direction_, speed_;
  double aside_ = 0.0;  // [rad], of its way against its lane, to the line's left
  std::size_t manoeuvre_ = 0;
  bool begun_ = false;
  Duration end_{};
};

}  // namespace ttf::sim::world::traffic
