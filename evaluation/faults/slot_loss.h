// A frame that did not come to whom it was owed, or came from somebody else; and who owes what to whom in a slot.
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

// Whose frame is expected there in this cycle; kNoNode: nobody's.
NodeId owner_of(const schedules::model::Cluster& cluster, int slot, schedules::model::Channel channel,
                std::int64_t cycle);

// Whether the receiver hears the frame's sender on this channel.
inline bool comes_on(const schedules::model::FrameSlot& frame, const schedules::model::Cluster& cluster,
                     NodeId receiver, schedules::model::Channel channel) {
  const auto& from = cluster.node(frame.sender).flexray;
  const auto& to = cluster.node(receiver).flexray;
  return from && to && includes(frame.channels, channel) && includes(from->pChannels, channel) &&
         includes(to->pChannels, channel);
}

}  // namespace ttf::evaluation::faults
