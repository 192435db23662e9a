// The schedules that nodes believe in where faults make them another than the cluster's: wrong slots, wrong lengths,
// the key slot of another node. Nodes, PDUs, tasks and sensors are the same; what differs is FlexRay's.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/ids.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::faults {

// Whether the fault is one of belief: wrong_schedule, or a duplicate_coldstart by the same key slot.
bool changes_schedule(const Fault& fault);

// Changes `believed` as such a fault does. Empty, or what is wrong with it in this cluster, "must ..."; `believed` is
// not changed then.
std::string believe(const Fault& fault, schedules::model::Cluster& believed);

class BelievedSchedules {
 public:
  // `plan`: resolved for this cluster. Several faults of one node add up.
  BelievedSchedules(const FaultPlan& plan, const schedules::model::Cluster& cluster);
  // Null: the cluster's.
  const schedules::model::Cluster* of(NodeId node) const { return believed_[index_of(node)].get(); }

 private:
  std::vector<std::unique_ptr<schedules::model::Cluster>> believed_;  // by NodeId
};

}  // namespace ttf::faults
