// How far a fault reaches, by its kind: whom it names, whose supply it takes, and what may be its doing beyond that.
#pragma once

#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

// The nodes that the fault names, or takes the supply of, by NodeId.
std::vector<bool> named_by(const ttf::faults::Fault& fault, const schedules::model::Cluster& cluster);
// Whether it takes the supply of `node`, one of these.
bool takes_supply(const ttf::faults::Fault& fault, NodeId node);

struct FaultReach {
  bool hearing = false;  // what the nodes receive that it names
  bool channel = false;  // slots of others in which it acts
  bool clocks = false;   // the cluster's common time
  Duration lasts{};      // what it puts on a channel, from the instant it acts on
};
FaultReach reach_of(const ttf::faults::Fault& fault, const schedules::model::Cluster& cluster);

}  // namespace ttf::evaluation::faults
