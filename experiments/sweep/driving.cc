#include "experiments/sweep/driving.h"

#include "nodes/control/r157.h"
#include "sim/drives/step_catalog.h"

namespace ttf::experiments::sweep {

std::optional<evaluation::driving::LaneConfig> lane_kept(const sim::drives::Scenario& scenario,
                                                         const schedules::model::Cluster& cluster) {
  const sim::world::vehicle::EgoConfig& ego = *scenario.world.ego;
  if (!ego.on || !scenario.world.road || !sim::drives::has_role(cluster, sim::drives::StepRole::kLaneKeeping))
    return std::nullopt;
  return evaluation::driving::LaneConfig{*scenario.world.road, ego.on->lane, ego.vehicle.wheelbase(), ego.width};
}

evaluation::driving::DrivingConfig driving_config(const sim::drives::Scenario& scenario,
                                                  const schedules::model::Cluster& cluster) {
  evaluation::driving::DrivingConfig config;
  config.front_m = scenario.world.ego->front;
  config.width_m = scenario.world.ego->width;
  config.time_gap_s = scenario.cruise.law.time_gap_s;
  config.standstill_m = scenario.cruise.law.standstill_m;
  config.hazard_time_s = {scenario.emergency.warning_time_s, scenario.emergency.braking_time_s};
  config.reaction_speed_mps = scenario.reaction_speed_mps;
  config.minimum_gap = &nodes::control::minimum_following_distance;
  config.lane = lane_kept(scenario, cluster);
  if (const auto actuators = sim::drives::tasks_with(cluster, sim::drives::StepRole::kActuator); !actuators.empty())
    config.reads_every = cluster.cycle() * actuators.front().task->activation.at.repetition;
  config.warns_ahead = sim::drives::has_role(cluster, sim::drives::StepRole::kEmergencyBraking);
  if (sim::drives::has_role(cluster, sim::drives::StepRole::kBlindSpotWarning)) {
    const nodes::driving::BlindSpotConfig& spot = scenario.blind_spot;
    config.blind_spot = {spot.ahead_m, spot.behind_m, spot.nearest_m, spot.furthest_m};
  }
  return config;
}

}  // namespace ttf::experiments::sweep
