// Which frame belongs in which slot, as one node sees it. Slots 1..gNumberOfStaticSlots are static, those above
// dynamic.
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

  // What this node sends, by slot, then base cycle.
  std::span<const schedules::model::FrameSlot* const> own_static() const { return own_static_; }
  std::span<const schedules::model::FrameSlot* const> own_dynamic(schedules::model::Channel channel) const {
    return own_dynamic_[index_of(channel)];
  }
  // Whether another node ever sends in the slot.
  bool others_send_in(int slot) const { return !others_in(slot).empty(); }
  // The frame that another node sends there, by channel; null where nobody does. `counter`: cycle counter, 0..63.
  std::array<const schedules::model::FrameSlot*, 2> expected(int slot, int counter) const {
    if (slot < 1 || static_cast<std::size_t>(slot) > steady_.size()) return {};
    const Steady& steady = steady_[static_cast<std::size_t>(slot - 1)];
    return steady.every_cycle ? steady.frames : expected_by_cycle(slot, counter);
  }
  const schedules::model::FrameSlot* expected(int slot, int counter, schedules::model::Channel channel) const {
    return expected(slot, counter)[index_of(channel)];
  }
  // The one that another node sends on both channels there; null where that is not the same frame, or none.
  const schedules::model::FrameSlot* expected_on_both(int slot, int counter) const {
    const auto frames = expected(slot, counter);
    return frames[0] == frames[1] ? frames[0] : nullptr;
  }
  // In how many static slots of a cycle other nodes send, if they do so on both channels in all of them; else -1.
  int pairs(int counter) const { return pairs_[static_cast<std::size_t>(counter)]; }
  // The same in the dynamic segment, where several may share a slot, told apart by message id: the one with that id (or
  // without one); null where that is not expected.
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
  std::vector<const schedules::model::FrameSlot*> others_;  // what other nodes send, by slot
  std::vector<std::size_t> first_;                          // by slot - 1, where it begins in others_
  // What is expected of a slot where that is the same in every cycle.
  struct Steady {
    bool every_cycle = true;
    std::array<const schedules::model::FrameSlot*, 2> frames{};  // by channel
  };
  std::vector<Steady> steady_;  // by slot - 1
  std::vector<int> pairs_;      // by counter
};

using schedules::model::in_cycle;

}  // namespace ttf::bus::controller
