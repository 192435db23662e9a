// The judgement of a drive in which commands drive the vehicle, by its scenario.
#pragma once

#include <optional>

#include "evaluation/driving/driving_account.h"
#include "schedules/model/cluster.h"
#include "sim/drives/scenario.h"

namespace ttf::experiments::sweep {

// Returns the account's settings for a scenario whose vehicle commands drive, and for the services of its cluster.
evaluation::driving::DrivingConfig driving_config(const sim::drives::Scenario& scenario,
                                                  const schedules::model::Cluster& cluster);
// Returns the lane on which the vehicle starts, if a service of the cluster keeps it.
std::optional<evaluation::driving::LaneConfig> lane_kept(const sim::drives::Scenario& scenario,
                                                         const schedules::model::Cluster& cluster);
// Returns whether commands drive the scenario's vehicle.
inline bool is_driven(const sim::drives::Scenario& scenario) {
  return scenario.world.ego && scenario.world.ego->actuator;
}

}  // namespace ttf::experiments::sweep
