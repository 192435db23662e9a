// Known offsets with jitter: by hand, against all releases of small sets, and against critical instants that run.
#include "schedules/timing/response/offsets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "core/random.h"
#include "tests/schedules/timing/simulated_resource.h"

namespace ttf::schedules::timing::response {
namespace {

TaskTimes offset_task(std::int64_t work, std::int64_t period, std::optional<std::int64_t> offset, std::int64_t jitter) {
  return {.period = period, .work = work, .deadline = period, .jitter = jitter, .blocking = 0, .offset = offset};
}

// Calls release(task, arrival) for each job from `from` to `until`, and simulates them.
template <class Release>
std::int64_t simulated_with(const std::vector<TaskTimes>& tasks, std::int64_t from, std::int64_t until,
                            Release release) {
  std::vector<SimulatedJob> jobs;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const std::int64_t period = tasks[i].period;
    std::int64_t at = *tasks[i].offset % period;
    while (at > from) at -= period;
    for (; at < until; at += period) jobs.push_back({i, at, release(tasks[i], at), tasks[i].work});
  }
  return simulated_longest(jobs, tasks.size(), Preemption::kAlways, from - 1'000).back();
}

// Two tasks have a period of 10. The second arrives 5 behind the first. A jitter of 3 brings the first no nearer than 2. A
// jitter of 4 of the second lets it meet the first.
TEST(Offsets, KeepJobsApart) {
  const auto second = [](std::int64_t first_jitter, std::int64_t second_jitter) {
    const std::vector<TaskTimes> tasks{offset_task(2, 10, 0, first_jitter), offset_task(3, 10, 5, second_jitter)};
    return preemptive(tasks)[1];
  };
  EXPECT_EQ(second(3, 0), (Response{Quality::kExact, 3}));
  EXPECT_EQ(second(4, 0), (Response{Quality::kExact, 4})) << "released at 4, done at 6";
  EXPECT_EQ(second(0, 4), (Response{Quality::kExact, 9})) << "from 9 to 10, and from 12 to 14";
  EXPECT_EQ(second(0, 5), (Response{Quality::kExact, 10})) << "both at 10";
}

TEST(Offsets, BelowTasksOfAnyPhase) {
  const std::vector<TaskTimes> tasks{offset_task(1, 4, {}, 0), offset_task(2, 10, 0, 3), offset_task(3, 10, 5, 0)};
  // Both others come at 3, and the first again at 7: the last works from 6 to 7, and from 8 to 10.
  EXPECT_EQ(preemptive(tasks)[2], (Response{Quality::kExact, 5}));
  EXPECT_EQ(response_with_offsets({}, tasks[0]), std::nullopt);
  TaskTimes blocked = tasks[2];
  blocked.blocking = 1;
  EXPECT_EQ(response_with_offsets({}, blocked), std::nullopt);
}

struct DrawnOffsets {
  std::vector<TaskTimes> tasks;  // the last is asked about
  std::int64_t repeats = 1;
  double load = 0;

  DrawnOffsets(RandomStream& stream, std::int64_t most_tasks, std::vector<std::int64_t> periods,
               std::int64_t most_jitter, bool any_phase) {
    for (std::int64_t left = stream.integer(1, most_tasks); left > 0; --left) {
      const std::int64_t period =
          periods[static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(periods.size()) - 1))];
      const std::int64_t work = stream.integer(1, std::max<std::int64_t>(1, period / 3));
      const std::int64_t offset = stream.integer(0, period - 1);
      TaskTimes task = offset_task(work, period, offset, stream.integer(0, most_jitter));
      if (left == 1) task.jitter = std::min(task.jitter, period);
      if (left > 1 && any_phase && stream.integer(0, 2) == 0) task.offset.reset();
      load += static_cast<double>(task.work) / static_cast<double>(period);
      repeats = std::lcm(repeats, period);
      tasks.push_back(task);
    }
  }

  // Tasks without an offset get one.
  template <class Phase> std::vector<TaskTimes> placed(Phase phase) const {
    std::vector<TaskTimes> found = tasks;
    for (TaskTimes& one : found)
      if (!one.offset) one.offset = phase(one);
    return found;
  }
};

// At a critical instant all jobs come that may. Those before it come early, and those behind it at once.
std::int64_t longest_of_critical_instants(const DrawnOffsets& drawn) {
  std::int64_t longest = 0;
  for (std::int64_t start = 0; start < drawn.repeats; ++start) {
    const std::vector<TaskTimes> tasks = drawn.placed(
        [&](const TaskTimes& one) { return ((start - one.jitter) % one.period + one.period) % one.period; });
    longest = std::max(longest, simulated_with(tasks, -2 * drawn.repeats, 3 * drawn.repeats,
                                               [&](const TaskTimes& task, std::int64_t at) {
                                                 return at <= start && at + task.jitter >= start ? start : at;
                                               }));
  }
  return longest;
}

TEST(Offsets, DrawnSetsReachTheirResponsesAtCriticalInstants) {
  int judged = 0, below_any_phase = 0, too_long = 0;
  for (std::uint32_t index = 0; index < 3'000; ++index) {
    RandomStream stream({.seed = 51, .purpose = Purpose::kTest, .index = index});
    const DrawnOffsets drawn(stream, 4, {4, 5, 6, 8, 10, 12, 20}, 9, true);
    if (drawn.load > 0.999 || drawn.repeats > 120) continue;
    const auto higher = std::span(drawn.tasks).first(drawn.tasks.size() - 1);
    const auto found = response_with_offsets(higher, drawn.tasks.back());
    if (!found) {  // its busy period takes too many steps
      ++too_long;
      continue;
    }
    ++judged;
    for (int draw = 0; draw < 5; ++draw) {
      const std::vector<TaskTimes> tasks =
          drawn.placed([&](const TaskTimes& one) { return stream.integer(0, one.period - 1); });
      const std::int64_t some =
          simulated_with(tasks, -drawn.repeats, 3 * drawn.repeats, [&](const TaskTimes& task, std::int64_t at) {
            return at + stream.integer(0, 1) * stream.integer(0, task.jitter);
          });
      ASSERT_LE(some, *found) << "set " << index;
    }
    if (index % 4 == 0) {
      ASSERT_EQ(longest_of_critical_instants(drawn), *found) << "set " << index;
    }
    const Response coarse = preemptive_response(higher, drawn.tasks.back());
    ASSERT_TRUE(coarse.bounded());
    ASSERT_LE(*found, coarse.longest) << "set " << index;
    below_any_phase += *found < coarse.longest ? 1 : 0;
  }
  EXPECT_GT(judged, 1'500);
  EXPECT_LE(too_long, 3);
  EXPECT_GT(below_any_phase, 500);
}

// Every job of two or three hyperperiods comes at once or one later, in all combinations.
TEST(Offsets, AllReleasesOfSmallSets) {
  int judged = 0;
  for (std::uint32_t index = 0; index < 150; ++index) {
    RandomStream stream({.seed = 52, .purpose = Purpose::kTest, .index = index});
    const DrawnOffsets drawn(stream, 2, {3, 4, 6}, 1, false);
    if (drawn.load > 0.999) continue;
    const std::int64_t until = 2 * drawn.repeats + 6;
    int jobs = 0;
    simulated_with(drawn.tasks, 0, until, [&](const TaskTimes& task, std::int64_t at) {
      jobs += task.jitter > 0 ? 1 : 0;
      return at;
    });
    if (jobs > 9) continue;
    std::int64_t longest = 0;
    for (unsigned late = 0; late < 1U << jobs; ++late) {
      unsigned next = 0;
      longest = std::max(longest, simulated_with(drawn.tasks, 0, until, [&](const TaskTimes& task, std::int64_t at) {
                           return task.jitter > 0 && ((late >> next++) & 1U) != 0 ? at + 1 : at;
                         }));
    }
    const auto found = response_with_offsets(std::span(drawn.tasks).first(drawn.tasks.size() - 1), drawn.tasks.back());
    ASSERT_EQ(found, longest) << "set " << index;
    ++judged;
  }
  EXPECT_GT(judged, 60);
}

}  // namespace
}  // namespace ttf::schedules::timing::response
