// A frame that did not reach its receiver, or came from another sender; and the owners of slots.
#pragma once

#include <cstdint>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

struct SlotLoss {
  TrueTime at{};
  NodeId receiver{}, sender{};
  int slot = 0;
  std::int64_t cycle = 0;  // counter
  bool forged = false;     // H5, a valid frame that the sender did not send; else H4 (checks.h)
};

// Returns the node whose frame is expected there in this cycle; kNoNode: none.
NodeId owner_of(const schedules::model::Cluster& cluster, int slot, schedules::model::Channel channel,
                std::int64_t cycle);

// Returns whether the receiver hears the frame's sender on this channel.
inline bool comes_on(const schedules::model::FrameSlot& frame, const schedules::model::Cluster& cluster,
                     NodeId receiver, schedules::model::Channel channel) {
  const auto& from = cluster.node(frame.sender).flexray;
  const auto& to = cluster.node(receiver).flexray;
  return from && to && includes(frame.channels, channel) && includes(from->pChannels, channel) &&
         includes(to->pChannels, channel);
}

}  // namespace ttf::evaluation::faults
