// Steers a vehicle along a lane (journey.h).
#pragma once

#include <optional>

#include "sim/world/road/lane_change.h"
#include "sim/world/road/road.h"
#include "sim/world/vehicle/single_track.h"

namespace ttf::sim::world::vehicle {

class LaneKeeping {
 public:
  // Begins on a lane's middle, at the place where the vehicle is.
  LaneKeeping(const road::Road& road, int lane, const Parameters& vehicle, const Motion& motion);

  // Changes to another lane; the vehicle keeps its direction.
  void change(int lane, Duration within);
  // Returns the yaw rate [rad/s] that keeps the vehicle to its lane, and goes on by `seconds`.
  double yaw_rate(const Parameters& vehicle, const Motion& motion, double seconds);

 private:
  const road::Road* road_;
  road::LaneChange change_;
  int lane_;
  double direction_, station_;
};

}  // namespace ttf::sim::world::vehicle
