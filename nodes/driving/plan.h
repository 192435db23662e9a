// A motion plan, as a list on the bus with one element. It has the speed to drive at [m/s], the planner's state
// (nodes/control/gap_planner.h) and the most important object's id. An invalid one asks for nothing. The stamp is the
// instant of the issue.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "nodes/host/step.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::driving {

struct Plan {
  bool valid = false;
  double speed = 0.0;
  recording::records::PlannerState state{};
};

using PlanSignals = std::array<std::size_t, 4>;
PlanSignals bind_plan(const schedules::model::Cluster& cluster, const schedules::model::PduLayout& layout);
// Returns the plan of a list; an empty list is invalid.
Plan decode_plan(const schedules::model::PduLayout& layout, const bus::cni::ListView& list, const PlanSignals& signals);

// The output `plan` of a planner: it numbers its lists, and records each as its readers decode it.
class PlanOutput {
 public:
  PlanOutput(const schedules::model::Cluster& cluster, const schedules::model::Task& task);
  // `record` says why; plan, list and stamp are filled in.
  void issue(host::StepContext& context, const Plan& plan, recording::records::PlanMade record);

 private:
  std::size_t port_ = 0;  // among the outputs
  PlanSignals signals_;
  std::uint32_t sequence_ = 0;
};

}  // namespace ttf::nodes::driving
