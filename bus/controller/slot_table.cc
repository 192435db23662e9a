#include "bus/controller/slot_table.h"

#include <algorithm>

namespace ttf::bus::controller {

using schedules::model::Channel;
using schedules::model::FrameSlot;

SlotTable::SlotTable(const schedules::model::Cluster& cluster, NodeId node) {
  for (const FrameSlot& frame : cluster.frames) {
    if (frame.sender != node) {
      others_.push_back(&frame);
    } else if (frame.slot <= cluster.flexray.gNumberOfStaticSlots) {
      own_static_.push_back(&frame);
    } else {
      for (const Channel channel : schedules::model::kBothChannels)
        if (includes(frame.channels, channel)) own_dynamic_[index_of(channel)].push_back(&frame);
    }
  }
  const auto by_slot = [](const FrameSlot* a, const FrameSlot* b) { return a->slot < b->slot; };
  std::stable_sort(own_static_.begin(), own_static_.end(), by_slot);
  std::stable_sort(others_.begin(), others_.end(), by_slot);
  for (std::size_t f = 0; f < others_.size(); ++f) first_.resize(static_cast<std::size_t>(others_[f]->slot), f);
  first_.push_back(others_.size());
  steady_.resize(first_.size() - 1);
  for (const FrameSlot* frame : others_)
    steady_[static_cast<std::size_t>(frame->slot - 1)].every_cycle &= frame->repetition == 1;
  for (std::size_t s = 0; s < steady_.size(); ++s) steady_[s].frames = expected_by_cycle(static_cast<int>(s) + 1, 0);
  pairs_.resize(static_cast<std::size_t>(cluster.flexray.gCycleCountMax + 1));
  for (std::size_t counter = 0; counter < pairs_.size(); ++counter)
    for (int slot = 1; slot <= cluster.flexray.gNumberOfStaticSlots && pairs_[counter] >= 0; ++slot) {
      const auto sent = expected(slot, static_cast<int>(counter));
      if ((sent[0] == nullptr) != (sent[1] == nullptr))
        pairs_[counter] = -1;
      else if (sent[0] != nullptr)
        ++pairs_[counter];
    }
  for (auto& own : own_dynamic_) std::stable_sort(own.begin(), own.end(), by_slot);
}

std::array<const FrameSlot*, 2> SlotTable::expected_by_cycle(int slot, int counter) const {
  std::array<const FrameSlot*, 2> found{};
  for (const FrameSlot* frame : others_in(slot)) {
    if (!in_cycle(*frame, counter)) continue;
    for (const Channel channel : schedules::model::kBothChannels)
      if (found[index_of(channel)] == nullptr && includes(frame->channels, channel)) found[index_of(channel)] = frame;
  }
  return found;
}

const FrameSlot* SlotTable::expected(int slot, int counter, Channel channel,
                                     std::optional<std::uint16_t> message_id) const {
  for (const FrameSlot* frame : others_in(slot))
    if (in_cycle(*frame, counter) && includes(frame->channels, channel) && frame->message_id == message_id)
      return frame;
  return nullptr;
}

}  // namespace ttf::bus::controller
