// Every pair of stage and event, and the ways through the stages.
#include "nodes/runner/held_stage.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <initializer_list>
#include <map>
#include <optional>

namespace ttf::nodes::runner {
namespace {

using Stage = HeldStage;
using Event = HeldEvent;

std::optional<Stage> after(std::initializer_list<Event> events) {
  std::optional<Stage> stage = Stage::kArrived;
  for (const Event event : events) {
    if (!stage) return std::nullopt;
    stage = next_stage(*stage, event);
  }
  return stage;
}

TEST(HeldStage, StandsInTheOrderOfItsLists) {
  for (std::size_t i = 0; i < kAllHeldStages.size(); ++i) EXPECT_EQ(static_cast<std::size_t>(kAllHeldStages[i]), i);
  for (std::size_t i = 0; i < kAllHeldEvents.size(); ++i) EXPECT_EQ(static_cast<std::size_t>(kAllHeldEvents[i]), i);
}

// A finding about a frame leads to the same stage from every waiting stage.
TEST(HeldStage, EveryFindingLeadsToOneStage) {
  const std::map<Event, Stage> leads{{Event::kOfNextCycle, Stage::kAwaitsCycle},
                                     {Event::kInWindow, Stage::kPlaced},
                                     {Event::kOutsideWindow, Stage::kRefused},
                                     {Event::kWithoutSlot, Stage::kPlaced}};
  for (const Stage stage : {Stage::kArrived, Stage::kAwaitsFollowUp, Stage::kAwaitsCycle})
    for (const auto& [event, next] : leads) EXPECT_EQ(next_stage(stage, event), next) << static_cast<int>(stage);
}

TEST(HeldStage, AFollowUpIsAwaitedOnce) {
  EXPECT_EQ(after({Event::kLatenessUnknown}), Stage::kAwaitsFollowUp);
  EXPECT_EQ(after({Event::kLatenessUnknown, Event::kFollowUp}), Stage::kArrived);
  EXPECT_EQ(after({Event::kFollowUp}), Stage::kArrived) << "it comes before the node has got to its frame";
  EXPECT_EQ(after({Event::kLatenessUnknown, Event::kLatenessUnknown}), std::nullopt);
  EXPECT_EQ(after({Event::kOfNextCycle, Event::kLatenessUnknown}), std::nullopt);
}

TEST(HeldStage, AFollowUpEndsNoWaitForACycle) {
  EXPECT_EQ(after({Event::kLatenessUnknown, Event::kOfNextCycle, Event::kFollowUp}), Stage::kAwaitsCycle);
}

TEST(HeldStage, OnlyWhatIsPlacedEnds) {
  for (const Stage stage : kAllHeldStages) {
    const bool placed = stage == Stage::kPlaced;
    EXPECT_EQ(next_stage(stage, Event::kEnded), placed ? std::optional(Stage::kHandedOver) : std::nullopt);
    EXPECT_EQ(next_stage(stage, Event::kCycleOver), placed ? std::optional(Stage::kRefused) : std::nullopt);
  }
}

TEST(HeldStage, NothingHappensToWhatIsGone) {
  for (const Stage stage : {Stage::kHandedOver, Stage::kRefused})
    for (const Event event : kAllHeldEvents) EXPECT_EQ(next_stage(stage, event), std::nullopt);
}

TEST(HeldStage, APlacedFrameIsNotPlacedAgain) {
  for (const Event event : {Event::kFollowUp, Event::kLatenessUnknown, Event::kOfNextCycle, Event::kInWindow,
                            Event::kOutsideWindow, Event::kWithoutSlot})
    EXPECT_EQ(next_stage(Stage::kPlaced, event), std::nullopt);
}

}  // namespace
}  // namespace ttf::nodes::runner
