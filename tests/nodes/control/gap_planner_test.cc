#include "nodes/control/gap_planner.h"

#include <gtest/gtest.h>

#include <vector>

namespace ttf::nodes::control {
namespace {

using enum PlannerState;

// The state after one step from `state`, after start-up.
PlannerState after(PlannerState state, std::optional<MostImportant> object, std::optional<double> before = 29.0) {
  PlannerMemory memory{state, before};
  planned_speed({}, 9.0, object, memory);
  return memory.state;
}

TEST(GapPlanner, EveryTransition) {
  const MostImportant near{36.9, 29.0}, between{40.0, 29.0}, far{43.1, 29.0};
  const struct {
    PlannerState state, if_near, if_between, if_far, if_clear;
  } table[] = {{kDecelerate, kDecelerate, kDecelerate, kHold, kHold},
               {kHold, kDecelerate, kHold, kAccelerate, kHold},
               {kAccelerate, kHold, kAccelerate, kAccelerate, kHold},
               {kStop, kStop, kStop, kStop, kStop}};
  for (const auto& row : table) {
    EXPECT_EQ(after(row.state, near), row.if_near);
    EXPECT_EQ(after(row.state, between), row.if_between);
    EXPECT_EQ(after(row.state, far), row.if_far);
    EXPECT_EQ(after(row.state, std::nullopt), row.if_clear);
    // The object's speed falls through 28 m/s.
    EXPECT_EQ(after(row.state, MostImportant{40.0, 27.9}, 28.1), kStop);
  }
  EXPECT_EQ(after(kDecelerate, MostImportant{43.0, 29.0}), kHold) << "the largest gap is reached";
  EXPECT_EQ(after(kAccelerate, MostImportant{37.0, 29.0}), kHold) << "the smallest gap is reached";
  EXPECT_EQ(after(kHold, MostImportant{37.0, 29.0}), kHold);
  EXPECT_EQ(after(kHold, MostImportant{43.0, 29.0}), kHold);
}

TEST(GapPlanner, AFallNeedsTwoObjectsAndItsThreshold) {
  const MostImportant slow{40.0, 27.9};
  EXPECT_EQ(after(kHold, slow, std::nullopt), kHold);
  EXPECT_EQ(after(kHold, slow, 27.95), kHold) << "it was slow before";
  EXPECT_EQ(after(kHold, slow, 28.0), kHold);
  EXPECT_EQ(after(kHold, MostImportant{40.0, 28.0}, 29.0), kHold);
}

TEST(GapPlanner, SpeedsOfTheStates) {
  const MostImportant near{30.0, 25.0}, far{50.0, 25.0};
  PlannerMemory memory;
  EXPECT_EQ(planned_speed({}, 3.0, near, memory), 24.5);
  EXPECT_EQ(planned_speed({}, 3.1, std::nullopt, memory), 30.0);
  EXPECT_EQ(planned_speed({}, 3.2, far, memory), 25.5);
  memory.speed = 29.0;
  EXPECT_EQ(planned_speed({}, 3.3, far, memory), 0.0);
  EXPECT_EQ(planned_speed({}, 3.4, std::nullopt, memory), 0.0) << "for ever";
}

TEST(GapPlanner, StartUpHasNoTransition) {
  GapPlannerConfig config;
  config.start_mps = 29.0;
  PlannerMemory memory{kHold, 29.0};
  EXPECT_EQ(planned_speed(config, 2.49, MostImportant{10.0, 20.0}, memory), 29.0);
  EXPECT_EQ(memory.state, kHold);
  EXPECT_EQ(planned_speed(config, 2.5, MostImportant{10.0, 20.0}, memory), 19.5) << "its fall is past";
}

TEST(GapPlanner, TheMostImportantIsTheNearestConfirmedInTheLane) {
  const std::vector<Candidate> tracks{
      {50.0, -3.0, true}, {20.0, -3.0, false}, {30.0, 0.0, true}, {-5.0, -3.0, true}, {40.0, -5.8, true}};
  EXPECT_EQ(most_important(tracks, -5.9, -0.1), 4u);
  EXPECT_EQ(most_important(tracks, -5.7, -0.1), 0u);
  EXPECT_EQ(most_important(tracks, 5.0, 9.0), std::nullopt);
}

}  // namespace
}  // namespace ttf::nodes::control
