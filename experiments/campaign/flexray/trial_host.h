// The host of one node in a trial: writes its lists and its network management vector anew in every cycle, so
// that all frames differ.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bus/controller/controller.h"
#include "core/ids.h"
#include "schedules/model/cluster.h"

namespace ttf::experiments::campaign::flexray {

class TrialHost {
 public:
  TrialHost(const schedules::model::Cluster& cluster, NodeId node);
  void write(bus::controller::FlexRayController& controller, std::int64_t cycle);

 private:
  void write_list(bus::controller::FlexRayController& controller, PduId pdu, std::int64_t cycle);
  void write_vector(bus::controller::FlexRayController& controller, std::int64_t cycle);

  const schedules::model::Cluster& cluster_;
  NodeId node_;
  std::vector<PduId> pdus_;
  std::vector<std::byte> list_, vector_;
};

}  // namespace ttf::experiments::campaign::flexray
