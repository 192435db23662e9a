// The schedules that faulty nodes believe in: wrong slots, wrong lengths, or the key slot of another node. Only
// FlexRay's part differs from the cluster; nodes, PDUs, tasks and sensors are the same.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/ids.h"
#include "faults/plan.h"
#include "schedules/model/cluster.h"

namespace ttf::faults {

// Returns whether the fault changes a belief: wrong_schedule, or duplicate_coldstart with the same key slot.
bool changes_schedule(const Fault& fault);

// Changes `believed` as such a fault does. Returns an empty text, or an objection ("must ...") and leaves
// `believed` unchanged.
std::string believe(const Fault& fault, schedules::model::Cluster& believed);

class BelievedSchedules {
 public:
  // `plan` is resolved for this cluster. Several faults of one node accumulate.
  BelievedSchedules(const FaultPlan& plan, const schedules::model::Cluster& cluster);
  // Returns null for a node that believes in the cluster's schedule.
  const schedules::model::Cluster* of(NodeId node) const { return believed_[index_of(node)].get(); }

 private:
  std::vector<std::unique_ptr<schedules::model::Cluster>> believed_;  // by NodeId
};

}  // namespace ttf::faults
