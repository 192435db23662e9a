// The slot table maps slots to frames, as one node sees them. Slots 1..gNumberOfStaticSlots are static, those
// above dynamic.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::controller {

class SlotTable {
 public:
  SlotTable(const schedules::model::Cluster& cluster, NodeId node);

  // Own frames, by slot, then base cycle.
  std::span<const schedules::model::FrameSlot* const> own_static() const { return own_static_; }
  std::span<const schedules::model::FrameSlot* const> own_dynamic(schedules::model::Channel channel) const {
    return own_dynamic_[index_of(channel)];
  }
  // Returns whether another node ever sends in the slot.
  bool others_send_in(int slot) const { return !others_in(slot).empty(); }
  // Returns the frame of another node in that slot, by channel; null without one. `counter`: cycle counter, 0..63.
  std::array<const schedules::model::FrameSlot*, 2> expected(int slot, int counter) const {
    if (slot < 1 || static_cast<std::size_t>(slot) > steady_.size()) return {};
    const Steady& steady = steady_[static_cast<std::size_t>(slot - 1)];
    return steady.every_cycle ? steady.frames : expected_by_cycle(slot, counter);
  }
  const schedules::model::FrameSlot* expected(int slot, int counter, schedules::model::Channel channel) const {
    return expected(slot, counter)[index_of(channel)];
  }
  // Returns the frame that another node sends on both channels in that slot; null otherwise.
  const schedules::model::FrameSlot* expected_on_both(int slot, int counter) const {
    const auto frames = expected(slot, counter);
    return frames[0] == frames[1] ? frames[0] : nullptr;
  }
  // Returns the number of static slots per cycle in which other nodes send; -1 unless they use both channels
  // in all of them.
  int pairs(int counter) const { return pairs_[static_cast<std::size_t>(counter)]; }
  // The same for the dynamic segment, where several frames may share a slot with different message ids:
  // returns the one with that id, or without one. Null if the frame is not expected.
  const schedules::model::FrameSlot* expected(int slot, int counter, schedules::model::Channel channel,
                                              std::optional<std::uint16_t> message_id) const;

 private:
  std::array<const schedules::model::FrameSlot*, 2> expected_by_cycle(int slot, int counter) const;
  std::vector<const schedules::model::FrameSlot*> own_static_;
  std::array<std::vector<const schedules::model::FrameSlot*>, 2> own_dynamic_;  // by channel
  std::span<const schedules::model::FrameSlot* const> others_in(int slot) const {
    if (slot < 1 || static_cast<std::size_t>(slot) >= first_.size()) return {};
    const auto s = static_cast<std::size_t>(slot);
    return {others_.data() + first_[s - 1], others_.data() + first_[s]};
  }
  std::vector<const schedules::model::FrameSlot*> others_;  // other nodes' frames, by slot
  std::vector<std::size_t> first_;                          // by slot - 1: its beginning in others_
  // The frames expected in a slot, if they are the same in every cycle.
  struct Steady {
    bool every_cycle = true;
    std::array<const schedules::model::FrameSlot*, 2> frames{};  // by channel
  };
  std::vector<Steady> steady_;  // by slot - 1
  std::vector<int> pairs_;      // by counter
};

using schedules::model::in_cycle;

}  // namespace ttf::bus::controller
