#include "bus/can_controller.h"

#include <algorithm>

#include "core/check.h"
#include "schedules/can_load.h"

namespace ttf::bus {

CanController::CanController(const schedules::Cluster& cluster, NodeId node, std::size_t can_bus, CanPort& port)
    : cluster_(cluster), bus_(cluster.can_buses[can_bus]), node_(node), port_(port), padded_(64) {
  for (const schedules::CanMessage& message : bus_.messages)
    incoming_.push_back(message.sender == node ? nullptr
                                               : std::make_unique<IncomingList>(cluster.pdu(message.pdu)));
}

void CanController::send(PduId pdu, const ListView& list) {
  const auto message = std::find_if(bus_.messages.begin(), bus_.messages.end(), [&](const schedules::CanMessage& m) {
    return m.pdu == pdu && m.sender == node_;
  });
  TTF_CHECK(message != bus_.messages.end(), "{} does not send this PDU on {}", cluster_.node(node_).name, bus_.name);
  const auto fragment = static_cast<std::size_t>(cluster_.pdu(pdu).fragment_bytes);
  const auto data_length = schedules::can_data_length(bus_.flexible_data_rate, cluster_.pdu(pdu).fragment_bytes);
  TTF_CHECK(data_length.has_value(), "{} bytes on {}", fragment, bus_.name);
  const auto length = static_cast<std::size_t>(*data_length);
  for (int f = 0; f < list.fragments; ++f) {
    const auto payload = list.bytes.subspan(static_cast<std::size_t>(f) * fragment, fragment);
    std::fill(padded_.begin(), padded_.end(), std::byte{0});
    std::copy(payload.begin(), payload.end(), padded_.begin());
    port_.send({message->identifier, bus_.flexible_data_rate, std::span<const std::byte>(padded_).first(length)});
  }
}

std::optional<CanController::Arrival> CanController::receive(const CanFrame& frame) {
  for (std::size_t m = 0; m < bus_.messages.size(); ++m) {
    const schedules::CanMessage& message = bus_.messages[m];
    if (message.identifier != frame.identifier || !incoming_[m]) continue;
    const auto bytes = static_cast<std::size_t>(cluster_.pdu(message.pdu).fragment_bytes);
    if (frame.data.size() < bytes) break;
    IncomingList& list = *incoming_[m];
    const ArrivalEffect effect = list.arrive(frame.data.first(bytes));
    return Arrival{message.pdu, effect, list.arrived(), list.torn()};
  }
  ++foreign_frames_;
  return std::nullopt;
}

IncomingList& CanController::incoming(PduId pdu) {
  for (std::size_t m = 0; m < bus_.messages.size(); ++m)
    if (bus_.messages[m].pdu == pdu && incoming_[m]) return *incoming_[m];
  TTF_CHECK(false, "{} does not receive this PDU on {}", cluster_.node(node_).name, bus_.name);
}

}  // namespace ttf::bus
