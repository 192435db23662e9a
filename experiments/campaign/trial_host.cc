#include "experiments/campaign/trial_host.h"

#include <algorithm>
#include <span>
#include <string_view>

#include "bus/wire/pdu_codec.h"

namespace ttf::experiments::campaign {
namespace {

// Writes the lower bits of the value, as many as the signal has.
void write_header(const schedules::model::PduLayout& layout, std::span<std::byte> payload, std::string_view name,
                  std::uint32_t value) {
  const std::size_t signal = bus::wire::header_signal(layout, name);
  const int bits = layout.header[signal].bits;
  bus::wire::write_header_raw(layout, payload, signal, bits >= 32 ? value : value & ((1u << bits) - 1));
}

}  // namespace

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
  const schedules::model::PduLayout& layout = cluster_.pdu(pdu);
  const auto bytes = static_cast<std::size_t>(layout.fragment_bytes);
  const int fragments = layout.max_fragments();
  list_.assign(bytes * static_cast<std::size_t>(fragments), std::byte{0});
  for (int fragment = 0; fragment < fragments; ++fragment) {
    const auto payload = std::span<std::byte>(list_).subspan(bytes * static_cast<std::size_t>(fragment), bytes);
    write_header(layout, payload, "sequence", static_cast<std::uint32_t>(cycle));
    write_header(layout, payload, "fragment", static_cast<std::uint32_t>(fragment));
    write_header(layout, payload, "count", static_cast<std::uint32_t>(layout.max_elements));
  }
  controller.outgoing(pdu).write({static_cast<std::uint32_t>(cycle), fragments, list_});
}

void TrialHost::write_vector(bus::controller::FlexRayController& controller, std::int64_t cycle) {
  vector_.front() = static_cast<std::byte>(index_of(node_) + 1);
  vector_.back() = static_cast<std::byte>(cycle & 0xff);
  controller.set_network_management_vector(vector_);
}

}  // namespace ttf::experiments::campaign
