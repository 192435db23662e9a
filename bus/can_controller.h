// A node's controller on one private CAN: lists out as frames of one identifier, frames in as lists.
//
// All fragments of a list are queued at once, in order; arbitration is the medium's. CAN FD payloads are padded with zeros to the
// next length there is. Frames with an identifier the schedule does not know are counted and ignored.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "bus/can_port.h"
#include "bus/list_buffer.h"
#include "core/ids.h"
#include "schedules/cluster.h"

namespace ttf::bus {

class CanController {
 public:
  CanController(const schedules::Cluster& cluster, NodeId node, std::size_t can_bus, CanPort& port);

  // `pdu` must be a message of this bus that the node sends.
  void send(PduId pdu, const ListView& list);

  struct Arrival {
    PduId pdu{};
    ArrivalEffect effect{};
    std::uint32_t sequence = 0;          // of the list the fragment belongs to
    std::optional<std::uint32_t> torn;   // the list it displaced before that was complete
  };
  // Nothing for a foreign frame.
  std::optional<Arrival> receive(const CanFrame& frame);
  // `pdu` must be a message of this bus that another node sends.
  IncomingList& incoming(PduId pdu);
  std::uint64_t foreign_frames() const { return foreign_frames_; }

 private:
  const schedules::Cluster& cluster_;
  const schedules::CanBus& bus_;
  NodeId node_;
  CanPort& port_;
  std::vector<std::unique_ptr<IncomingList>> incoming_;   // by message of the bus
  std::vector<std::byte> padded_;
  std::uint64_t foreign_frames_ = 0;
};

}  // namespace ttf::bus
