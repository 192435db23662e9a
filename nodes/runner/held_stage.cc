#include "nodes/runner/held_stage.h"

#include <cstddef>

namespace ttf::nodes::runner {
namespace {

using S = HeldStage;
constexpr std::optional<HeldStage> kNone;  // the event cannot come

using Row = std::array<std::optional<HeldStage>, kAllHeldEvents.size()>;

// A row for each stage, a column for each event, both in the order of their enums.
constexpr std::array<Row, kAllHeldStages.size()> kNext{{
    // kFollowUp, kLatenessUnknown, kOfNextCycle, kInWindow, kOutsideWindow, kWithoutSlot, kEnded, kCycleOver
    {S::kArrived, S::kAwaitsFollowUp, S::kAwaitsCycle, S::kPlaced, S::kRefused, S::kPlaced, kNone, kNone},  // kArrived
    {S::kArrived, kNone, S::kAwaitsCycle, S::kPlaced, S::kRefused, S::kPlaced, kNone, kNone},      // kAwaitsFollowUp
    {S::kAwaitsCycle, kNone, S::kAwaitsCycle, S::kPlaced, S::kRefused, S::kPlaced, kNone, kNone},  // kAwaitsCycle
    {kNone, kNone, kNone, kNone, kNone, kNone, S::kHandedOver, S::kRefused},                       // kPlaced
    {kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone},                                      // kHandedOver
    {kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone},                                      // kRefused
}};

}  // namespace

std::optional<HeldStage> next_stage(HeldStage stage, HeldEvent event) {
  return kNext[static_cast<std::size_t>(stage)][static_cast<std::size_t>(event)];
}

}  // namespace ttf::nodes::runner
