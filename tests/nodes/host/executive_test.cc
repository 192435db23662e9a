// The executive's law and its rules of order. Times in microseconds from the start of cycle 0; macroticks are
// microseconds.
#include "nodes/host/executive.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/nodes/host/one_node.h"

namespace ttf::nodes::host {
namespace {

using Ran = Runs::Run;

TEST(Executive, TasksStartAtTheInstantsOfTheSchedule) {
  OneNode node({at(300, task("third", 10)), at(100, task("first", 10)), at(200, task("second", 10), 2)});
  node.run_to(2, 0);
  EXPECT_EQ(node.recorded.runs, (std::vector<Ran>{{1, 100, 100, 110, true},
                                                  {2, 200, 200, 210, true},
                                                  {0, 300, 300, 310, true},
                                                  {1, 1100, 1100, 1110, true},
                                                  {0, 1300, 1300, 1310, true}}));
}

TEST(Executive, AChainRunsLinkByLinkEachAtTheEndOfTheLast) {
  OneNode node({after("b", task("c", 30)), at(100, task("a", 10)), after("a", task("b", 20))});
  node.run_to(1, 0);
  EXPECT_EQ(node.recorded.runs,
            (std::vector<Ran>{{1, 100, 100, 110, true}, {2, 110, 110, 130, true}, {0, 130, 130, 160, true}}));
}

//   a 100 ======= 150
//   b   110 waits 150 == 170
//   c     120 waits      170 = 180
TEST(Executive, HasOneProcessorAndStartsInOrderOfActivation) {
  OneNode node({at(120, task("c", 10)), at(110, task("b", 20)), at(100, task("a", 50))});
  node.run_to(1, 0);
  EXPECT_EQ(node.recorded.runs,
            (std::vector<Ran>{{2, 100, 100, 150, true}, {1, 110, 150, 170, true}, {0, 120, 170, 180, true}}));
}

// At 150 three are activated at once: by the end of a, by the schedule, and by the schedule again.
TEST(Executive, OfOneInstantTheEarlierInTheFileIsFirstWhateverActivatesIt) {
  const auto order = [](std::vector<schedules::model::Task> tasks) {
    OneNode node(std::move(tasks));
    node.run_to(1, 0);
    std::vector<int> started;
    for (const Ran& run : node.recorded.runs)
      if (run.activated == 150) started.push_back(run.task);
    return started;
  };
  const auto chained = [] { return after("a", task("chained", 5)); };
  const auto timed = [](const char* name) { return at(150, task(name, 5)); };
  const auto a = [] { return at(100, task("a", 50)); };
  EXPECT_EQ(order({chained(), timed("x"), timed("y"), a()}), (std::vector{0, 1, 2}));
  EXPECT_EQ(order({timed("x"), chained(), timed("y"), a()}), (std::vector{0, 1, 2}));
  EXPECT_EQ(order({timed("x"), a(), timed("y"), chained()}), (std::vector{0, 2, 3}));
}

// An earlier activation comes first though it stands later in the file.
TEST(Executive, TheFileDecidesTiesOnly) {
  OneNode node({at(120, task("later", 5)), at(110, task("earlier", 5)), at(100, task("busy", 50))});
  node.run_to(1, 0);
  ASSERT_EQ(node.recorded.runs.size(), 3u);
  EXPECT_EQ(node.recorded.runs[1].task, 1);
}

TEST(Executive, AnActivationOnTopOfAWaitingOneIsAnOverrun) {
  // Busy for 2.5 cycles from 100 on. Two of the activations at 200, 1200, 2200 meet the first, still waiting.
  OneNode node({at(100, task("busy", 2500), 4), at(200, task("short", 10))});
  node.run_to(3, 0);
  EXPECT_EQ(node.executive->counts().overruns, 2u);
  EXPECT_EQ(node.recorded.runs, (std::vector<Ran>{{0, 100, 100, 2600, true}, {1, 200, 2600, 2610, true}}));
}

TEST(Executive, AMissedDeadlineIsRecordedAndCounted) {
  OneNode node(
      {at(100, task("a", 50, 50)), at(110, task("b", 20, 59)), at(300, task("c", 60, 59)), at(500, task("d", 0, 0))});
  node.run_to(1, 0);
  EXPECT_EQ(
      node.recorded.runs,
      (std::vector<Ran>{
          {0, 100, 100, 150, true}, {1, 110, 150, 170, false}, {2, 300, 300, 360, false}, {3, 500, 500, 500, true}}))
      << "a deadline counts from the activation, waiting included, and is met on the tick";
  EXPECT_EQ(node.executive->counts().deadlines_missed, 2u);
}

TEST(Executive, ExecutionTimesAreDrawnBetweenTheirBoundsAlikeForASeed) {
  schedules::model::Task drawn = at(100, task("drawn", 0));
  drawn.best_case = Duration::microseconds(100);
  drawn.worst_case = Duration::microseconds(300);
  drawn.draw = schedules::model::ExecutionDraw::kUniform;
  OneNode first({drawn}), second({drawn});
  first.run_to(200, 0);
  second.run_to(200, 0);
  ASSERT_EQ(first.recorded.runs.size(), 200u);
  EXPECT_EQ(first.recorded.runs, second.recorded.runs);
  const auto [shortest, longest] =
      std::minmax_element(first.recorded.runs.begin(), first.recorded.runs.end(),
                          [](const Ran& a, const Ran& b) { return a.end - a.start < b.end - b.start; });
  EXPECT_GE(shortest->end - shortest->start, 100);
  EXPECT_LT(shortest->end - shortest->start, 110);
  EXPECT_LE(longest->end - longest->start, 300);
  EXPECT_GT(longest->end - longest->start, 290);
}

// The law: a task's outputs are there at its end rather than at their computation.
TEST(Executive, OutputsBecomeVisibleAtTheEnd) {
  schedules::model::Task writer = at(100, task("writer", 40));
  writer.writes = {{"out", bus::kList, schedules::model::kFlexRay, 0}};
  const auto write = std::make_shared<Scripted>([](StepContext& context) {
    context.outputs[0].begin(7, 3, GlobalTime{});
    for (int i = 0; i < 3; ++i) context.outputs[0].set(i, 0, 10.0 + i);
  });
  OneNode node({writer}, {write});
  node.run_to(0, 139);
  EXPECT_TRUE(node.recorded.hops.empty());
  node.run_to(0, 140);
  ASSERT_EQ(node.recorded.hops.size(), 1u);
  EXPECT_EQ(node.recorded.hops[0].what, recording::records::Hop::kWritten);
  EXPECT_EQ(node.recorded.hops[0].sequence, 7u);
  EXPECT_EQ(node.recorded.hops[0].at, 140);
}

}  // namespace
}  // namespace ttf::nodes::host
