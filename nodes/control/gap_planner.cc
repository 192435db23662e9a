#include "nodes/control/gap_planner.h"

namespace ttf::nodes::control {
namespace {

PlannerState next(const GapPlannerConfig& config, PlannerState state, const std::optional<MostImportant>& object,
                  bool fell) {
  switch (state) {
    case PlannerState::kStop: return PlannerState::kStop;
    case PlannerState::kDecelerate:
      if (fell) return PlannerState::kStop;
      return !object || object->gap >= config.largest_gap_m ? PlannerState::kHold : state;
    case PlannerState::kAccelerate:
      if (fell) return PlannerState::kStop;
      return !object || object->gap <= config.smallest_gap_m ? PlannerState::kHold : state;
    case PlannerState::kHold:
      if (fell) return PlannerState::kStop;
      if (object && object->gap < config.smallest_gap_m) return PlannerState::kDecelerate;
      return object && object->gap > config.largest_gap_m ? PlannerState::kAccelerate : state;
  }
  return state;  // all states are listed
}

}  // namespace

double planned_speed(const GapPlannerConfig& config, double since_start, const std::optional<MostImportant>& object,
                     PlannerMemory& memory) {
  const bool fell =
      object && memory.speed && *memory.speed > config.emergency_mps && object->speed < config.emergency_mps;
  memory.speed = object ? std::optional(object->speed) : std::nullopt;
  if (since_start < config.start_up_s) return config.start_mps;
  memory.state = next(config, memory.state, object, fell);
  switch (memory.state) {
    case PlannerState::kDecelerate: return object->speed - config.speed_step_mps;
    case PlannerState::kAccelerate: return object->speed + config.speed_step_mps;
    case PlannerState::kHold: return config.cruise_mps;
    case PlannerState::kStop: return 0.0;
  }
  return 0.0;  // all states are listed
}

std::optional<std::size_t> most_important(std::span<const Candidate> tracks, double right, double left) {
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Candidate& track = tracks[i];
    if (!track.confirmed || track.x < 0.0 || track.y < right || track.y > left) continue;
    if (!nearest || track.x < tracks[*nearest].x) nearest = i;
  }
  return nearest;
}

}  // namespace ttf::nodes::control
