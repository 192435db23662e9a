// A pure step for held arrivals: (stage, event) -> next stage, every pair listed in held_stage.cc. The arrival
// window (nodes/runner/arrival_window.h) finds the events and acts on the stages.
//
//                     lateness unknown                  of the next cycle
//   arrived ---------------------------> awaits follow-up -----> awaits its cycle
//      | \          <--- follow-up ---        |                       |
//      |  +-----------------------------------+-----------------------+---> placed --ended--> handed over
//      +--> refused: outside its window, or its cycle is over
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace ttf::nodes::runner {

enum class HeldStage : std::uint8_t {
  kArrived,         // a frame that is placed when the node reaches the instant of its arrival
  kAwaitsFollowUp,  // a sync frame of unknown lateness, until its follow-up states it or no longer comes
  kAwaitsCycle,     // a frame of the next cycle, until that begins
  kPlaced,          // has a begin and an end on the node's clock, and waits for its end
  kHandedOver,      // its bytes are in use
  kRefused,         // never handed over
};
inline constexpr std::array kAllHeldStages = {HeldStage::kArrived, HeldStage::kAwaitsFollowUp, HeldStage::kAwaitsCycle,
                                              HeldStage::kPlaced,  HeldStage::kHandedOver,     HeldStage::kRefused};

enum class HeldEvent : std::uint8_t {
  kFollowUp,  // it states how late the frame left

  // Findings about a frame that is to be placed
  kLatenessUnknown,  // a sync frame whose lateness is still unknown; asked once
  kOfNextCycle,      // ahead of the node's clock
  kInWindow,
  kOutsideWindow,
  kWithoutSlot,  // without a slot and cycle that the node has

  // The end of a placed frame has come
  kEnded,
  kCycleOver,  // but its cycle was already over
};
inline constexpr std::array kAllHeldEvents = {
    HeldEvent::kFollowUp,      HeldEvent::kLatenessUnknown, HeldEvent::kOfNextCycle, HeldEvent::kInWindow,
    HeldEvent::kOutsideWindow, HeldEvent::kWithoutSlot,     HeldEvent::kEnded,       HeldEvent::kCycleOver};

// Returns nothing if the event cannot come in that stage.
std::optional<HeldStage> next_stage(HeldStage stage, HeldEvent event);

}  // namespace ttf::nodes::runner
