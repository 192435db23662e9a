// Which frame belongs in which slot, as one node sees it. Slots 1..gNumberOfStaticSlots are static, those above dynamic.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "schedules/cluster.h"

namespace ttf::bus {

class SlotTable {
 public:
  SlotTable(const schedules::Cluster& cluster, NodeId node);

  // What this node sends, by slot, then base cycle.
  std::span<const schedules::FrameSlot* const> own_static() const { return own_static_; }
  std::span<const schedules::FrameSlot* const> own_dynamic(schedules::Channel channel) const {
    return own_dynamic_[index_of(channel)];
  }
  // The frame that another node sends there; null where nobody does. `counter`: cycle counter, 0..63.
  const schedules::FrameSlot* expected(int slot, int counter, schedules::Channel channel) const;
  // The same in the dynamic segment, where several may share a slot, told apart by message id: the one with that id (or
  // without one); null where that is not expected.
  const schedules::FrameSlot* expected(int slot, int counter, schedules::Channel channel,
                                       std::optional<std::uint16_t> message_id) const;

 private:
  std::vector<const schedules::FrameSlot*> own_static_;
  std::array<std::vector<const schedules::FrameSlot*>, 2> own_dynamic_;      // by channel
  std::vector<std::vector<const schedules::FrameSlot*>> expected_;           // by slot - 1
};

// Whether the frame has its turn in a cycle with this counter.
constexpr bool in_cycle(const schedules::FrameSlot& frame, int counter) {
  return counter % frame.repetition == frame.base_cycle;
}

}  // namespace ttf::bus
