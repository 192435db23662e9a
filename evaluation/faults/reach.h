// The reach of a fault by its kind: the nodes that it names, the supplies that it takes, and further possible
// effects.
#pragma once

#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

// Returns by NodeId whether the fault names the node, or takes its supply.
std::vector<bool> named_by(const ttf::faults::Fault& fault, const schedules::model::Cluster& cluster);
// Returns whether the fault takes the supply of `node`, one of those.
bool takes_supply(const ttf::faults::Fault& fault, NodeId node);

struct FaultReach {
  bool reception = false;  // reception of the nodes that it names
  bool channel = false;    // others' slots in which it acts
  bool clocks = false;     // the cluster's common time
  Duration lasts{};        // duration of its signals on a channel, from the act on
};
FaultReach reach_of(const ttf::faults::Fault& fault, const schedules::model::Cluster& cluster);

}  // namespace ttf::evaluation::faults
