// The motion planner of Wolfe's adaptive detection: a speed to ask for, from the most important object ahead.
//
//   state          speed asked for            left when                                              for
//   decelerate     the object's less 0.5 m/s  the largest gap is reached, or the lane is clear       hold
//   hold           cruise                     gap < smallest                                         decelerate
//                                             gap > largest                                          accelerate
//   accelerate     the object's and 0.5 m/s   the smallest gap is reached, or the lane is clear      hold
//   stop           0                          never
//   any other                                 the object's speed falls through the emergency speed   stop
// During start-up the planner asks for the start's speed and stays in its state. A fall needs an object in two steps in a row. It
// goes before the other conditions.
//
// Wolfe: "Adaptive object detection for autonomous vehicles" (Northern Illinois University, 2020), chapter 3. The rules are those
// of the text's table. The printed program differs: it takes an object's number for its place.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "recording/records/enumerations.h"

namespace ttf::nodes::control {

struct GapPlannerConfig {
  double cruise_mps = 30.0, start_mps = 30.0;
  double smallest_gap_m = 37.0, largest_gap_m = 43.0;
  double speed_step_mps = 0.5;
  double emergency_mps = 28.0;
  double start_up_s = 2.5;
};

using recording::records::PlannerState;

// The most important object: gap [m], speed over ground [m/s].
struct MostImportant {
  double gap = 0.0, speed = 0.0;
};

struct PlannerMemory {
  PlannerState state = PlannerState::kHold;
  std::optional<double> speed;  // the object's in the step before
};

// Returns the speed [m/s] to ask for `since_start` seconds after the start, and takes the memory on.
double planned_speed(const GapPlannerConfig& config, double since_start, const std::optional<MostImportant>& object,
                     PlannerMemory& memory);

// A track in the axes of the vehicle or of the road: x along the lane from the own front, y across it.
struct Candidate {
  double x = 0.0, y = 0.0;
  bool confirmed = false;
};
// Returns the index of the nearest confirmed track ahead with right <= y <= left [m]. These are the lane's edges, with half the
// width of a vehicle added on either side.
std::optional<std::size_t> most_important(std::span<const Candidate> tracks, double right, double left);

}  // namespace ttf::nodes::control
