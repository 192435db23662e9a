// The ways from a sensor to its actuators, for schedules/analysis/chain/chains.h.
#pragma once

#include <string>
#include <vector>

#include "core/ids.h"
#include "schedules/analysis/age_stages.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis::chain {

// Returns at most kMostChains (schedules/analysis/chain/chains.h), in the order of the tasks.
std::vector<std::vector<Reading>> ways_to_actuators(const model::Cluster& cluster, SensorId sensor);

// Returns "camera -> gateway.forward -> ... -> actuator.act".
std::string name_of(const model::Cluster& cluster, SensorId sensor, const std::vector<Reading>& way);

}  // namespace ttf::schedules::analysis::chain
