#include "experiments/sweep/driving.h"

#include "nodes/control/r157.h"

namespace ttf::experiments::sweep {

evaluation::driving::DrivingConfig driving_config(const drives::Scenario& scenario) {
  evaluation::driving::DrivingConfig config;
  config.front_m = scenario.world.ego->front;
  config.width_m = scenario.world.ego->width;
  config.time_gap_s = scenario.cruise.law.time_gap_s;
  config.standstill_m = scenario.cruise.law.standstill_m;
  config.hazard_time_s = {scenario.emergency.warning_time_s, scenario.emergency.braking_time_s};
  config.reaction_speed_mps = scenario.reaction_speed_mps;
  config.minimum_gap = &nodes::control::minimum_following_distance;
  return config;
}

}  // namespace ttf::experiments::sweep
