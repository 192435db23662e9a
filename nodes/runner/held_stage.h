// What becomes of an arrival that is held, as a pure step: (stage, event) -> next stage, every pair listed in
// held_stage.cc. The arrival window (nodes/runner/arrival_window.h) finds the events and does what follows from them.
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
  kArrived,         // a frame, to be placed when the node has got to the instant of its arrival
  kAwaitsFollowUp,  // a sync frame that does not say how late it left, until its follow-up does or comes no more
  kAwaitsCycle,     // a frame of the next cycle, until that begins
  kPlaced,          // it has a begin and an end on the node's clock, and waits for its end
  kHandedOver,      // its bytes are out
  kRefused,         // it is never handed over
};
inline constexpr std::array kAllHeldStages = {HeldStage::kArrived, HeldStage::kAwaitsFollowUp, HeldStage::kAwaitsCycle,
                                              HeldStage::kPlaced,  HeldStage::kHandedOver,     HeldStage::kRefused};

enum class HeldEvent : std::uint8_t {
  kFollowUp,  // how late it left is told

  // A frame that is to be placed is found to be
  kLatenessUnknown,  // a sync frame that has yet to be told how late it left; asked once
  kOfNextCycle,      // ahead of the node's clock
  kInWindow,
  kOutsideWindow,
  kWithoutSlot,  // of no slot and cycle that the node knows

  // The end of one that is placed has come
  kEnded,
  kCycleOver,  // and the cycle that it belongs to had gone before
};
inline constexpr std::array kAllHeldEvents = {
    HeldEvent::kFollowUp,      HeldEvent::kLatenessUnknown, HeldEvent::kOfNextCycle, HeldEvent::kInWindow,
    HeldEvent::kOutsideWindow, HeldEvent::kWithoutSlot,     HeldEvent::kEnded,       HeldEvent::kCycleOver};

// Nothing where the event cannot come in that stage.
std::optional<HeldStage> next_stage(HeldStage stage, HeldEvent event);

}  // namespace ttf::nodes::runner
