// The operating system alone: task execution without controllers, lists or steps. One microtick is 25 ns.
#include "nodes/host/processor.h"

#include <gtest/gtest.h>

#include "tests/nodes/host/one_node.h"

namespace ttf::nodes::host {
namespace {

constexpr Microticks after_us(std::int64_t count) { return {40 * count}; }

struct Alone {
  std::vector<schedules::model::Task> tasks;
  NodeTime time{NodeId{0}, timebase::Oscillator(25'000, 0, 0), nullptr};
  ExecutiveCounts counts;
  Processor processor;

  explicit Alone(std::vector<schedules::model::Task> made)
      : tasks(std::move(made)), processor(tasks, {1, 0, NodeId{0}}, time, counts) {}
};

TEST(Processor, RunsOneTaskFromItsStartToItsEnd) {
  Alone alone({task("a", 10)});
  EXPECT_EQ(alone.processor.next_event(), kNever<Microticks>) << "nothing is activated";
  EXPECT_EQ(alone.processor.start_next(after_us(1)), nullptr);
  EXPECT_TRUE(alone.processor.activate(0, after_us(5)));
  EXPECT_EQ(alone.processor.next_event(), after_us(5));
  const Processor::Running* running = alone.processor.start_next(after_us(5));
  ASSERT_NE(running, nullptr);
  EXPECT_EQ(running->task, 0u);
  EXPECT_EQ(running->activation, 0u);
  EXPECT_EQ(alone.processor.next_event(), after_us(15));
  EXPECT_FALSE(alone.processor.ends_by(after_us(15) - Microticks{1}));
  EXPECT_TRUE(alone.processor.ends_by(after_us(15)));
  EXPECT_EQ(alone.processor.finish(after_us(15)).run.end.true_time, TrueTime{15'000});
  EXPECT_EQ(alone.processor.next_event(), kNever<Microticks>);
}

TEST(Processor, ATaskActivatedWhileItRunsWaits) {
  Alone alone({task("a", 10), task("b", 10)});
  alone.processor.activate(0, after_us(0));
  ASSERT_NE(alone.processor.start_next(after_us(0)), nullptr);
  EXPECT_TRUE(alone.processor.activate(0, after_us(1))) << "it runs, but does not wait";
  EXPECT_FALSE(alone.processor.activate(0, after_us(2))) << "it waits already";
  EXPECT_EQ(alone.counts.overruns, 1u);
  EXPECT_TRUE(alone.processor.activate(1, after_us(3)));
  EXPECT_EQ(alone.processor.start_next(after_us(3)), nullptr) << "one processor";
  alone.processor.finish(after_us(10));
  const Processor::Running* running = alone.processor.start_next(after_us(10));
  ASSERT_NE(running, nullptr);
  EXPECT_EQ(running->task, 0u) << "activated first";
  EXPECT_EQ(running->activation, 1u);
  EXPECT_EQ(running->run.activated.true_time, TrueTime{1'000});
  EXPECT_TRUE(alone.processor.waits(1));
}

TEST(Processor, TheEndOfATaskActivatesItsSuccessors) {
  Alone alone({after("b", task("a", 10)), task("b", 10), after("b", task("c", 10)), after("a", task("d", 10))});
  alone.processor.activate_after(1, after_us(7));
  EXPECT_TRUE(alone.processor.waits(0));
  EXPECT_TRUE(alone.processor.waits(2));
  EXPECT_FALSE(alone.processor.waits(3));
}

TEST(Processor, ADeadlineCountsFromTheActivation) {
  Alone alone({task("a", 10, 15)});
  for (const std::int64_t waited : {5, 6}) {
    alone.processor.activate(0, after_us(0));
    const Processor::Running* running = alone.processor.start_next(after_us(waited));
    ASSERT_NE(running, nullptr);
    EXPECT_EQ(running->run.deadline_met, waited == 5);
    alone.processor.finish(after_us(waited + 10));
  }
  EXPECT_EQ(alone.counts.deadlines_missed, 1u);
}

TEST(Processor, TheShortestTimeIsTheBestCaseWhereItIsDrawn) {
  schedules::model::Task drawn = task("drawn", 10);
  drawn.best_case = Duration::microseconds(2);
  schedules::model::Task worst = drawn;
  drawn.draw = schedules::model::ExecutionDraw::kUniform;
  const Alone alone({drawn, worst});
  EXPECT_EQ(alone.processor.shortest(0), Duration::microseconds(2));
  EXPECT_EQ(alone.processor.shortest(1), Duration::microseconds(10));
}

}  // namespace
}  // namespace ttf::nodes::host
