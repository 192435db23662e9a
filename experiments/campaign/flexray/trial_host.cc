#include "experiments/campaign/flexray/trial_host.h"

#include <algorithm>

#include "experiments/campaign/full_list.h"

namespace ttf::experiments::campaign::flexray {
TrialHost::TrialHost(const schedules::model::Cluster& cluster, NodeId node) : cluster_(cluster), node_(node) {
  for (const schedules::model::FrameSlot& frame : cluster.frames)
    if (frame.sender == node && frame.pdu != kNoPdu && std::find(pdus_.begin(), pdus_.end(), frame.pdu) == pdus_.end())
      pdus_.push_back(frame.pdu);
  vector_.resize(static_cast<std::size_t>(cluster.flexray.gNetworkManagementVectorLength));
}

void TrialHost::write(bus::controller::FlexRayController& controller, std::int64_t cycle) {
  for (const PduId pdu : pdus_) write_list(controller, pdu, cycle);
  if (!vector_.empty()) write_vector(controller, cycle);
}

void TrialHost::write_list(bus::controller::FlexRayController& controller, PduId pdu, std::int64_t cycle) {
  controller.outgoing(pdu).write(full_list(cluster_.pdu(pdu), static_cast<std::uint32_t>(cycle), list_));
}

void TrialHost::write_vector(bus::controller::FlexRayController& controller, std::int64_t cycle) {
  vector_.front() = static_cast<std::byte>(index_of(node_) + 1);
  vector_.back() = static_cast<std::byte>(cycle & 0xff);
  controller.set_network_management_vector(vector_);
}

}  // namespace ttf::experiments::campaign::flexray
