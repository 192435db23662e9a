// The communication network interface (CNI) of one FlexRay controller. It cuts the lists that the host writes
// into fragments for the slots, and collects the lists that arrive.
//
// The first slot of a list in a cycle latches it, so that a write between two of its slots cannot tear it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bus/cni/list_buffer.h"
#include "core/ids.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::cni {

class Cni {
 public:
  Cni(const schedules::model::Cluster& cluster, NodeId node);

  OutgoingList& outgoing(PduId pdu);  // must be a PDU that this node sends
  IncomingList& incoming(PduId pdu);  // any other PDU on FlexRay

  // The content of a slot in a cycle.
  struct Fragment {
    std::span<const std::byte> payload;  // empty: a null frame
    std::uint32_t sequence = 0;
    bool last = false;  // completes the list for the first time
  };
  Fragment fetch(const schedules::model::FrameSlot& slot, std::int64_t cycle);
  // In the dynamic segment a fragment is sent once per list and channel. pending() returns whether the channel
  // still has to carry the slot's present fragment. carried() notes that it has.
  bool pending(const schedules::model::FrameSlot& slot, schedules::model::Channel channel, std::int64_t cycle);
  void carried(const schedules::model::FrameSlot& slot, schedules::model::Channel channel);

 private:
  struct Sent {
    OutgoingList current, latched;
    std::int64_t latched_cycle = -1;
    std::optional<std::uint32_t> completed;                            // newest sequence sent completely
    std::array<std::vector<std::optional<std::uint32_t>>, 2> carried;  // by channel and fragment: newest sent
    explicit Sent(const schedules::model::PduLayout& layout);
  };
  Sent& latch(const schedules::model::FrameSlot& slot, std::int64_t cycle);

  const schedules::model::Cluster& cluster_;
  NodeId node_;
  std::vector<std::unique_ptr<Sent>> sent_;              // by PduId
  std::vector<std::unique_ptr<IncomingList>> received_;  // by PduId
};

}  // namespace ttf::bus::cni
