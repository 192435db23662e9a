// Frames of a task with modes: their instants, alone and on a node.
#include "nodes/host/mode_frames.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/nodes/host/one_node.h"

namespace ttf::nodes::host {
namespace {

using schedules::model::ModeInstant;

// Mode 0: 3 ms at cycle 0 and 1 ms at cycle 4, of 6. Mode 1: 1 ms at cycle 0, of 2. The grid has the odd cycles.
schedules::model::Task in_modes(int base_cycle = 1) {
  schedules::model::Task made = task("detect", 3'000, 3'000);
  made.activation = {schedules::model::ActivationKind::kModes, {base_cycle, 2, Macroticks{100}}, "", kNoSensor, ""};
  const auto lasting = [](int cycle, int ms) { return ModeInstant{cycle, Duration::milliseconds(ms), 0, false, 0}; };
  made.modes = {{"long", 6, {lasting(0, 3), lasting(4, 1)}, 0}, {"short", 2, {lasting(0, 1)}, 0}};
  return made;
}

// The cycles that are due, with their turns: "1:0.0" is cycle 1, mode 0, place 0.
std::string turns(ModeFrames& frames, std::int64_t from, std::int64_t to) {
  std::string text;
  for (std::int64_t cycle = from; cycle < to; ++cycle) {
    if (!frames.due_in(cycle)) continue;
    const ModeTurn turn = frames.take();
    text += (text.empty() ? "" : " ") + std::to_string(cycle) + ":" + std::to_string(turn.mode) + "." +
            std::to_string(turn.place);
  }
  return text;
}

TEST(ModeFrames, FollowEachOtherFromTheGridOn) {
  const schedules::model::Task made = in_modes();
  ModeFrames frames(made);
  EXPECT_EQ(turns(frames, 0, 20), "1:0.0 5:0.1 7:0.0 11:0.1 13:0.0 17:0.1 19:0.0");
  EXPECT_EQ(frames.lasts({0, 1}), Duration::milliseconds(1));
}

TEST(ModeFrames, ChangeWhereAFrameBeginsAndOnlyThere) {
  const schedules::model::Task made = in_modes();
  ModeFrames frames(made);
  EXPECT_EQ(turns(frames, 0, 5), "1:0.0");
  EXPECT_TRUE(frames.choose(1));
  EXPECT_EQ(turns(frames, 2, 8), "3:1.0 5:1.0 7:1.0") << "a frame of two cycles";
  EXPECT_TRUE(frames.choose(0));
  EXPECT_EQ(turns(frames, 8, 12), "11:0.1");
  EXPECT_FALSE(frames.choose(1)) << "the frame's second instant was taken";
  EXPECT_EQ(turns(frames, 12, 18), "13:0.0 17:0.1");
}

TEST(ModeFrames, BeginAnewWhereAnInstantWasMissed) {
  const schedules::model::Task made = in_modes();
  ModeFrames frames(made);
  EXPECT_EQ(turns(frames, 0, 4), "1:0.0");
  EXPECT_EQ(turns(frames, 6, 12), "7:0.0 11:0.1") << "cycle 5 was missed, and 6 is not on the grid";
  frames.forget();
  EXPECT_EQ(turns(frames, 2, 8), "3:0.0 7:0.1") << "on another count of cycles";
}

// On a node, all instants are at their macrotick. Executions are as long as the modes say, and the step chooses the modes.
TEST(ModesOfANode, BeginAtTheirInstantsAndLastAsTheyShould) {
  std::vector<ModeTurn> seen;
  std::size_t wanted = 0;
  OneNode node({in_modes()}, {std::make_shared<Scripted>([&](StepContext& context) {
                 ASSERT_TRUE(context.turn.has_value());
                 if (context.turn->place == 0) context.turn->mode = wanted;
                 seen.push_back(*context.turn);
               })});
  node.run_to(8);  // a frame from cycle 1 on, one from 7 on
  wanted = 1;
  node.run_to(14);  // the frame from 7 on stays; one from 13 on
  node.run_to(16);
  wanted = 0;
  node.run_to(22);  // short frames from 13 and 15 on, a long one from 17 on
  using Run = Runs::Run;
  const auto run = [](std::int64_t cycle, std::int64_t ms) {
    const std::int64_t from = 1000 * cycle + 100;
    return Run{0, from, from, from + 1000 * ms, true};
  };
  EXPECT_EQ(node.recorded.runs,
            (std::vector<Run>{run(1, 3), run(5, 1), run(7, 3), run(11, 1), run(13, 1), run(15, 1), run(17, 3)}));
  ASSERT_EQ(seen.size(), 8u);
  EXPECT_EQ(seen[4], (ModeTurn{1, 0}));
  EXPECT_EQ(seen[7], (ModeTurn{0, 1})) << "it runs until 22.1 ms";
  EXPECT_EQ(node.executive->counts().deadlines_missed, 0u);
  EXPECT_EQ(node.executive->counts().overruns, 0u);
}

// The mode decides whether the deadline is met.
TEST(ModesOfANode, AreLateAsTheirExecutionsSay) {
  schedules::model::Task made = in_modes();
  made.deadline = Duration::milliseconds(2);
  std::size_t wanted = 1;
  OneNode node({made}, {std::make_shared<Scripted>([&](StepContext& context) {
                 if (context.turn->place == 0) context.turn->mode = wanted;
               })});
  node.run_to(4);
  EXPECT_EQ(node.executive->counts().deadlines_missed, 0u) << "1 ms instead of the first mode's 3 ms";
  wanted = 0;
  node.run_to(9);
  EXPECT_EQ(node.executive->counts().deadlines_missed, 1u);
  ASSERT_GE(node.recorded.runs.size(), 3u);
  EXPECT_FALSE(node.recorded.runs[2].deadline_met);
}

}  // namespace
}  // namespace ttf::nodes::host
