// A node's controller on one private CAN: lists out as frames of one identifier, frames in as lists.
//
// All fragments of a list are queued at once, in order; arbitration is the medium's. CAN FD payloads are padded with
// zeros to the next length there is. What the schedule does not lay down is counted and ignored.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "bus/cni/list_buffer.h"
#include "bus/ports/can_port.h"
#include "core/ids.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::cni {

// Frames a controller took no notice of, and why.
struct CanRefusals {
  std::uint64_t foreign = 0;  // an identifier that no other node has in the schedule
  std::uint64_t format = 0;   // CAN FD on a classic bus, or the other way round
  std::uint64_t length = 0;   // not as long as the message's frames are
};

class CanController {
 public:
  CanController(const schedules::model::Cluster& cluster, NodeId node, std::size_t can_bus, ports::CanPort& port);

  // `pdu` must be a message of this bus that the node sends, and the list whole.
  void send(PduId pdu, const ListView& list);
  // The list that a frame of this node with `raw` as its sequence number belongs to: the newest sent that has these low
  // bits. Frames leave later than they are queued, but never as many lists later as the field counts.
  std::uint32_t sent_sequence(PduId pdu, std::uint32_t raw) const;

  struct Arrival {
    PduId pdu{};
    ArrivalEffect effect{};
    std::uint32_t sequence = 0;         // of the list the fragment belongs to
    std::optional<std::uint32_t> torn;  // the list it displaced before that was complete
  };
  // Nothing for a refused frame.
  std::optional<Arrival> receive(const ports::CanFrame& frame);
  // `pdu` must be a message of this bus that another node sends.
  IncomingList& incoming(PduId pdu);
  const CanRefusals& refused() const { return refused_; }

 private:
  std::size_t message_of(PduId pdu) const;  // that this node sends
  std::size_t frame_length(const schedules::model::CanMessage& message) const;

  const schedules::model::Cluster& cluster_;
  const schedules::model::CanBus& bus_;
  NodeId node_;
  ports::CanPort& port_;
  std::vector<std::unique_ptr<IncomingList>> incoming_;  // by message of the bus
  std::vector<std::uint32_t> newest_sent_;               // by message of the bus
  std::vector<std::byte> padded_;
  CanRefusals refused_;
};

}  // namespace ttf::bus::cni
