// A node's controller on one private CAN: sends lists as frames of one identifier, and collects frames into lists.
//
// It queues all fragments of a list at once, in order; the medium arbitrates. CAN FD payloads are padded with
// zeros to the next length. Frames outside the schedule are counted and ignored.
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

// Ignored frames by cause.
struct CanRefusals {
  std::uint64_t foreign = 0;  // an identifier that no other node has in the schedule
  std::uint64_t format = 0;   // CAN FD on a classic bus, or the other way round
  std::uint64_t length = 0;   // not the length of the message's frames
};

class CanController {
 public:
  CanController(const schedules::model::Cluster& cluster, NodeId node, std::size_t can_bus, ports::CanPort& port);

  // `pdu` must be a message of this bus that the node sends; the list must be whole.
  void send(PduId pdu, const ListView& list);
  // Returns the list of this node's frame whose sequence number is `raw`: the newest sent one with these low
  // bits. Frames leave after they are queued, but never by as many lists as the field counts.
  std::uint32_t sent_sequence(PduId pdu, std::uint32_t raw) const;

  struct Arrival {
    PduId pdu{};
    ArrivalEffect effect{};
    std::uint32_t sequence = 0;         // the number of the fragment's list
    std::optional<std::uint32_t> torn;  // the incomplete list that it displaced
  };
  // Returns no value for a refused frame.
  std::optional<Arrival> receive(const ports::CanFrame& frame);
  // `pdu` must be a message of this bus that another node sends.
  IncomingList& incoming(PduId pdu);
  const CanRefusals& refused() const { return refused_; }

 private:
  std::size_t message_of(PduId pdu) const;  // must be a message that this node sends
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
