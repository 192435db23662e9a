#include "bus/cni/can_controller.h"

#include <algorithm>

#include "bus/wire/pdu_codec.h"
#include "core/check.h"
#include "schedules/analysis/can_load.h"

namespace ttf::bus::cni {

CanController::CanController(const schedules::model::Cluster& cluster, NodeId node, std::size_t can_bus,
                             ports::CanPort& port)
    : cluster_(cluster), bus_(cluster.can_buses[can_bus]), node_(node), port_(port), newest_sent_(bus_.messages.size()),
      padded_(64) {
  for (const schedules::model::CanMessage& message : bus_.messages)
    incoming_.push_back(message.sender == node ? nullptr : std::make_unique<IncomingList>(cluster.pdu(message.pdu)));
}

std::size_t CanController::message_of(PduId pdu) const {
  const auto message =
      std::find_if(bus_.messages.begin(), bus_.messages.end(),
                   [&](const schedules::model::CanMessage& m) { return m.pdu == pdu && m.sender == node_; });
  TTF_CHECK(message != bus_.messages.end(), "{} does not send this PDU on {}", cluster_.node(node_).name, bus_.name);
  return static_cast<std::size_t>(message - bus_.messages.begin());
}

std::size_t CanController::frame_length(const schedules::model::CanMessage& message) const {
  const int bytes = cluster_.pdu(message.pdu).fragment_bytes;
  const auto length = schedules::analysis::can_data_length(bus_.flexible_data_rate, bytes);
  TTF_CHECK(length.has_value(), "{} bytes on {}", bytes, bus_.name);
  return static_cast<std::size_t>(*length);
}

void CanController::send(PduId pdu, const ListView& list) {
  const std::size_t m = message_of(pdu);
  const schedules::model::CanMessage& message = bus_.messages[m];
  const auto fragment = static_cast<std::size_t>(cluster_.pdu(pdu).fragment_bytes);
  const std::size_t length = frame_length(message);
  TTF_CHECK(list.fragments > 0 && list.bytes.size() == static_cast<std::size_t>(list.fragments) * fragment,
            "{} bytes in {} fragments of {}", list.bytes.size(), list.fragments, cluster_.pdu(pdu).name);
  newest_sent_[m] = list.sequence;
  for (int f = 0; f < list.fragments; ++f) {
    const auto payload = list.bytes.subspan(static_cast<std::size_t>(f) * fragment, fragment);
    std::fill(padded_.begin(), padded_.end(), std::byte{0});
    std::copy(payload.begin(), payload.end(), padded_.begin());
    port_.send({message.identifier, bus_.flexible_data_rate, std::span<const std::byte>(padded_).first(length)});
  }
}

std::uint32_t CanController::sent_sequence(PduId pdu, std::uint32_t raw) const {
  const schedules::model::PduLayout& layout = cluster_.pdu(pdu);
  const std::uint32_t newest = newest_sent_[message_of(pdu)];
  const std::uint64_t circle = std::uint64_t{1} << layout.header[wire::header_signal(layout, "sequence")].bits;
  return newest - static_cast<std::uint32_t>((newest - raw) & (circle - 1));
}

std::optional<CanController::Arrival> CanController::receive(const ports::CanFrame& frame) {
  const auto known = std::find_if(
      bus_.messages.begin(), bus_.messages.end(),
      [&](const schedules::model::CanMessage& m) { return m.identifier == frame.identifier && m.sender != node_; });
  if (known == bus_.messages.end()) {
    ++refused_.foreign;
  } else if (frame.flexible_data_rate != bus_.flexible_data_rate) {
    ++refused_.format;
  } else if (frame.data.size() != frame_length(*known)) {
    ++refused_.length;
  } else {
    IncomingList& list = *incoming_[static_cast<std::size_t>(known - bus_.messages.begin())];
    const auto bytes = static_cast<std::size_t>(cluster_.pdu(known->pdu).fragment_bytes);
    const ArrivalEffect effect = list.arrive(frame.data.first(bytes));
    return Arrival{known->pdu, effect, list.arrived(), list.torn()};
  }
  return std::nullopt;
}

IncomingList& CanController::incoming(PduId pdu) {
  for (std::size_t m = 0; m < bus_.messages.size(); ++m)
    if (bus_.messages[m].pdu == pdu && incoming_[m]) return *incoming_[m];
  TTF_CHECK(false, "{} does not receive this PDU on {}", cluster_.node(node_).name, bus_.name);
}

}  // namespace ttf::bus::cni
