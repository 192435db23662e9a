// A frame that did not reach its receiver, or came from another sender; the owners of slots, and those to whom a frame
// is owed.
#pragma once

#include <cstdint>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/faults/standings.h"
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

// Returns whether the receiver receives the frame's sender on this channel.
inline bool comes_on(const schedules::model::FrameSlot& frame, const schedules::model::Cluster& cluster,
                     NodeId receiver, schedules::model::Channel channel) {
  const auto& from = cluster.node(frame.sender).flexray;
  const auto& to = cluster.node(receiver).flexray;
  return from && to && includes(frame.channels, channel) && includes(from->pChannels, channel) &&
         includes(to->pChannels, channel);
}

// Returns whether the frame, if its sender counts, is owed to the receiver: a fault-free, normal active node that receives the
// sender.
inline bool is_owed(const schedules::model::FrameSlot& frame, const schedules::model::Cluster& cluster,
                    const Standings& standings, NodeId receiver) {
  using enum schedules::model::Channel;
  return receiver != frame.sender && standings.counts(receiver) &&
         (comes_on(frame, cluster, receiver, kA) || comes_on(frame, cluster, receiver, kB));
}

}  // namespace ttf::evaluation::faults
