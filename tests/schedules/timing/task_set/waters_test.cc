// Chains as the automotive field has them (WATERS 2015): periods of 1 to 1000 ms, so that hyperperiods have many jobs.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/random.h"
#include "schedules/timing/task_set/verdict.h"
#include "tests/schedules/timing/waters.h"

namespace ttf::schedules::timing::task_set {
namespace {

// Two processors, with the tasks of the chain first. The drawn chain is over the tasks of both.
std::optional<TaskSet> drawn_set(RandomStream& stream, bool offsets) {
  TaskSet set;
  set.resources.resize(2);
  std::vector<std::int64_t> periods;
  for (std::size_t r = 0; r < 2; ++r)
    for (const WatersTask& drawn : draw_waters_tasks(stream, 0.7, 25)) {
      Task task;
      task.name = "t" + std::to_string(set.tasks.size());
      task.resource = r;
      task.period = Duration{drawn.period};
      task.deadline = Duration::milliseconds(1'000'000);
      task.best = task.worst = Duration{drawn.worst};
      if (offsets) task.offset = Duration{stream.integer(0, drawn.period - 1)};
      periods.push_back(drawn.period);
      set.tasks.push_back(task);
    }
  const std::optional<std::vector<std::size_t>> chain = draw_waters_chain(stream, periods);
  if (!chain) return std::nullopt;
  set.chains.push_back({.name = "c", .stages = *chain, .largest_age = std::nullopt});
  return set;
}

TEST(WatersChains, ExactTimesAreBelowTheBounds) {
  std::size_t judged = 0, below_davare = 0;
  for (std::uint32_t index = 0; index < 200; ++index) {
    RandomStream stream({.seed = 11, .purpose = Purpose::kTest, .index = index});
    const std::optional<TaskSet> known_set = drawn_set(stream, true);
    if (!known_set) continue;
    TaskSet unknown_set = *known_set;
    for (Task& task : unknown_set.tasks) task.offset.reset();
    const Verdict known = verdict_on(*known_set), unknown = verdict_on(unknown_set);
    if (!known.chains[0].times || !unknown.chains[0].times) continue;
    ++judged;
    const chain::EndToEnd& exact = *known.chains[0].times;
    const chain::EndToEnd& bound = *unknown.chains[0].times;
    EXPECT_TRUE(exact.exact) << "set " << index;
    EXPECT_EQ(exact.reaction.time, exact.age->time) << "set " << index;
    EXPECT_LE(exact.reduced_reaction.time, exact.reaction.time);
    EXPECT_LE(exact.reduced_age->time, exact.age->time);
    EXPECT_LE(exact.reaction.time, bound.reaction.time) << "set " << index;
    EXPECT_LE(exact.reduced_reaction.time, bound.reduced_reaction.time) << "set " << index;
    EXPECT_LE(exact.reduced_age->time, bound.reduced_age->time) << "set " << index;
    Duration davare{};
    for (const std::size_t t : known_set->chains[0].stages)
      davare += *unknown_set.tasks[t].period + Duration{unknown.responses.tasks[t].response.longest};
    EXPECT_LE(bound.reaction.time, davare) << "set " << index;
    below_davare += bound.reaction.time < davare ? 1 : 0;
  }
  EXPECT_GT(judged, 90U);
  EXPECT_GT(below_davare, 20U);
}

}  // namespace
}  // namespace ttf::schedules::timing::task_set
