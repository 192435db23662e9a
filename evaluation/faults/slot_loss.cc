#include "evaluation/faults/slot_loss.h"

#include "schedules/model/round.h"

namespace ttf::evaluation::faults {

NodeId owner_of(const schedules::model::Cluster& cluster, int slot, schedules::model::Channel channel,
                std::int64_t cycle) {
  const int counter = counter_in(cluster.flexray, cycle);
  for (const schedules::model::FrameSlot& frame : cluster.frames)
    if (frame.slot == slot && includes(frame.channels, channel) && schedules::model::in_cycle(frame, counter))
      return frame.sender;
  return kNoNode;
}

}  // namespace ttf::evaluation::faults
