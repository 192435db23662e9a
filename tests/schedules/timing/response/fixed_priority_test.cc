// Fixed priorities against all phases of small sets. Limits: full load, offsets, huge numbers.
#include "schedules/timing/response/fixed_priority.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/random.h"
#include "schedules/timing/response/simulation.h"
#include "tests/schedules/timing/response/load_tests.h"
#include "tests/schedules/timing/simulated_resource.h"

namespace ttf::schedules::timing::response {
namespace {

TaskTimes small_task(std::int64_t work, std::int64_t period, std::int64_t jitter = 0) {
  return {.period = period, .work = work, .deadline = period, .jitter = jitter, .blocking = 0, .offset = {}};
}

// Arrivals from each task's offset on, before `until`.
std::vector<SimulatedJob> jobs_from(const std::vector<TaskTimes>& tasks, const std::vector<std::int64_t>& offsets,
                                    std::int64_t until) {
  std::vector<SimulatedJob> jobs;
  for (std::size_t i = 0; i < tasks.size(); ++i)
    for (std::int64_t at = offsets[i]; at < until; at += tasks[i].period) jobs.push_back({i, at, at, tasks[i].work});
  return jobs;
}

std::int64_t repeats_of(const std::vector<TaskTimes>& tasks) {
  std::int64_t all = 1;
  for (const TaskTimes& one : tasks) all = std::lcm(all, one.period);
  return all;
}

// Calls `see` with every combination of offsets below the periods.
template <class See> void for_all_phases(const std::vector<TaskTimes>& tasks, See see) {
  std::vector<std::int64_t> offsets(tasks.size(), 0);
  for (;;) {
    see(offsets);
    std::size_t digit = 0;
    while (digit < tasks.size() && ++offsets[digit] == tasks[digit].period) offsets[digit++] = 0;
    if (digit == tasks.size()) return;
  }
}

// Draws tasks with small whole periods and a load of at most one.
std::vector<TaskTimes> small_set(RandomStream& stream, std::size_t count, std::int64_t longest) {
  for (;;) {
    std::vector<TaskTimes> tasks;
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t period = stream.integer(2, longest);
      tasks.push_back(small_task(stream.integer(1, std::max<std::int64_t>(1, period / 2)), period));
    }
    std::int64_t work = 0;
    const std::int64_t all = repeats_of(tasks);
    for (const TaskTimes& one : tasks) work += all / one.period * one.work;
    if (work <= all) return tasks;
  }
}

// The worst of all phases is the answer without offsets. Each phase's own worst is the answer with its offsets.
TEST(PreemptiveTasks, AllPhasesOfSmallSets) {
  RandomStream stream({.seed = 11});
  for (int set = 0; set < 25; ++set) {
    std::vector<TaskTimes> tasks = small_set(stream, 3, 7);
    const std::vector<Response> any_phase = preemptive(tasks);
    const std::int64_t until = 4 * repeats_of(tasks);
    std::vector<std::int64_t> worst(tasks.size(), 0);
    for_all_phases(tasks, [&](const std::vector<std::int64_t>& offsets) {
      const auto longest = simulated_longest(jobs_from(tasks, offsets, until), tasks.size(), Preemption::kAlways);
      std::vector<TaskTimes> placed = tasks;
      for (std::size_t i = 0; i < tasks.size(); ++i) {
        worst[i] = std::max(worst[i], longest[i]);
        placed[i].offset = offsets[i] + 3 * tasks[i].period;  // later periods of the same phase
      }
      const std::vector<Response> exact = preemptive(placed);
      for (std::size_t i = 0; i < tasks.size(); ++i)
        ASSERT_EQ(exact[i], (Response{Quality::kExact, longest[i]})) << "set " << set << ", task " << i;
    });
    for (std::size_t i = 0; i < tasks.size(); ++i)
      EXPECT_EQ(any_phase[i], (Response{Quality::kExact, worst[i]})) << "set " << set << ", task " << i;
  }
}

// The worst is a lower task that began one tick earlier. Some phase has it in its first busy period.
TEST(NonPreemptiveTasks, AllPhasesOfSmallSets) {
  RandomStream stream({.seed = 12});
  for (int set = 0; set < 25; ++set) {
    const std::vector<TaskTimes> tasks = small_set(stream, 3, 7);
    const std::vector<Response> any_phase = non_preemptive(tasks);
    std::vector<std::int64_t> worst(tasks.size(), 0);
    for_all_phases(tasks, [&](const std::vector<std::int64_t>& offsets) {
      const auto longest =
          simulated_longest(jobs_from(tasks, offsets, 4 * repeats_of(tasks)), tasks.size(), Preemption::kNever);
      for (std::size_t i = 0; i < tasks.size(); ++i) worst[i] = std::max(worst[i], longest[i]);
    });
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      ASSERT_EQ(any_phase[i].quality, Quality::kExact);
      EXPECT_EQ(any_phase[i].longest, worst[i]) << "set " << set << ", task " << i;
    }
  }
}

// Two of a kind may come 10 apart. The lower task waits for both, and the second for the first.
//
//   arrived    ^-190      ^10
//   released         0^    ^10
//   processor         |==40==|==40==|==30==|
TEST(PreemptiveTasks, JitterBringsTwoAtOnce) {
  const std::vector<TaskTimes> tasks{small_task(40, 200, 190), small_task(30, 1'000)};
  const std::vector<Response> responses = preemptive(tasks);
  EXPECT_EQ(responses[0], (Response{Quality::kExact, 230}));
  EXPECT_EQ(responses[1], (Response{Quality::kExact, 110}));
}

// J. Lehoczky 1990: works of 26 and 62, periods of 70 and 100. The fifth instance is the worst one.
TEST(PreemptiveTasks, DeadlinesBeyondPeriodsLookAtTheWholeBusyPeriod) {
  const std::vector<TaskTimes> tasks{small_task(26, 70), small_task(62, 100)};
  std::vector<SimulatedJob> jobs = jobs_from(tasks, {0, 0}, 700);
  const auto longest = simulated_longest(jobs, 2, Preemption::kAlways);
  EXPECT_EQ(longest[1], 118);
  EXPECT_EQ(preemptive(tasks)[1], (Response{Quality::kExact, 118}));
}

// At full load with blocking no busy period ends. Yet the response has a bound: each instance waits as long as the
// last.
TEST(PreemptiveTasks, FullLoadWithBlockingRepeatsWithTheHyperperiod) {
  std::vector<TaskTimes> tasks{small_task(1, 2), small_task(2, 4)};
  EXPECT_EQ(preemptive(tasks)[1], (Response{Quality::kExact, 4}));
  tasks[1].blocking = 3;
  EXPECT_EQ(preemptive(tasks)[1], (Response{Quality::kBound, 10}));
  // The same from a simulation: something else has the processor for 3.
  const auto longest = simulated_longest(jobs_from(tasks, {0, 0}, 400), 2, Preemption::kAlways, 3);
  EXPECT_EQ(longest[1], 10);
}

TEST(PreemptiveTasks, MoreThanFullLoadHasNoBound) {
  const std::vector<Response> responses =
      preemptive(std::vector<TaskTimes>{small_task(1, 2), small_task(3, 6), small_task(1, 1'000)});
  EXPECT_EQ(responses[1], (Response{Quality::kExact, 6}));
  EXPECT_EQ(responses[2], Response{});
  EXPECT_FALSE(responses[2].keeps(kLongestResponse));
}

// Jitter queues 10^12 instances, too many to look at. The closed form is J + (C + C_1) / (1 - 1/2). In fact the first
// instance waits for J + 2.
TEST(PreemptiveTasks, ManyInstancesFallBackToTheClosedForm) {
  const std::int64_t jitter = 3'000'000'000'000;
  const std::vector<TaskTimes> tasks{small_task(1, 2), small_task(1, 3, jitter)};
  EXPECT_EQ(preemptive(tasks)[1], (Response{Quality::kBound, jitter + 4}));
  EXPECT_EQ(preemptive(std::vector<TaskTimes>{small_task(1, 2), small_task(1, 3, 300)})[1],
            (Response{Quality::kExact, 302}));
}

TEST(PreemptiveTasks, HugeNumbersDoNotOverflow) {
  const std::int64_t most = kLongestArgument;
  const std::vector<TaskTimes> tasks{small_task(most / 2, most, most), small_task(most / 4, most, most),
                                     small_task(most / 8, most, most)};
  const std::vector<Response> responses = preemptive(tasks);
  EXPECT_EQ(responses[0], (Response{Quality::kExact, most / 2 + most}));
  EXPECT_EQ(responses[1].longest, most + 3 * (most / 2) + most / 4) << "three of the higher before the first ends";
  for (const Response& one : responses) EXPECT_TRUE(one.bounded());
  std::vector<TaskTimes> coprime;
  for (const std::int64_t period : {most, most - 1, most - 3, most - 5})
    coprime.push_back(small_task(most / 4, period));
  EXPECT_EQ(preemptive(coprime)[3], Response{}) << "above one by less than 2^-50";
}

// Any times up to the longest: an answer, without overflow or endless loops.
TEST(PreemptiveTasks, DrawnMagnitudesHaveAnAnswer) {
  RandomStream stream({.seed = 14});
  int bounded = 0;
  for (int set = 0; set < 30; ++set) {
    std::vector<TaskTimes> tasks;
    for (int i = 0; i < 4; ++i) {
      const std::int64_t period = std::int64_t{2} << stream.integer(0, 55);
      TaskTimes task =
          small_task(stream.integer(1, std::max<std::int64_t>(1, period / 3)), period - stream.integer(0, 1));
      task.jitter = stream.integer(0, std::int64_t{1} << stream.integer(0, 56));
      task.blocking = stream.integer(0, std::int64_t{1} << stream.integer(0, 56));
      tasks.push_back(task);
    }
    for (const std::vector<Response>& responses : {preemptive(tasks), non_preemptive(tasks)})
      for (std::size_t i = 0; i < tasks.size(); ++i) {
        if (!responses[i].bounded()) continue;
        ++bounded;
        ASSERT_GE(responses[i].longest, tasks[i].work + tasks[i].jitter);
      }
  }
  EXPECT_GT(bounded, 60);
}

// One of three tasks has no offset. It has a bound. The task below it meets either of the others.
TEST(PreemptiveTasks, OffsetsOfSomeAreABoundForTheRest) {
  std::vector<TaskTimes> tasks{small_task(1, 4), small_task(1, 4), small_task(1, 4)};
  tasks[0].offset = 0;
  tasks[2].offset = 2;
  const std::vector<Response> responses = preemptive(tasks);
  EXPECT_EQ(responses[0], (Response{Quality::kExact, 1}));
  EXPECT_EQ(responses[1], (Response{Quality::kBound, 2}));
  EXPECT_EQ(responses[2], (Response{Quality::kExact, 2}));
  tasks[1].offset = 0;
  EXPECT_EQ(preemptive(tasks)[2], (Response{Quality::kExact, 1}));
}

TEST(SimulatedTasks, TooManyJobsAreNotSimulated) {
  std::vector<TaskTimes> tasks{small_task(1, 3), small_task(1, 5'000'011)};
  for (TaskTimes& one : tasks) one.offset = 1;
  EXPECT_EQ(simulated_responses(tasks), std::nullopt);
  EXPECT_EQ(preemptive(tasks)[1], (Response{Quality::kExact, 2})) << "offsets.h looks at three jobs alone";
  tasks[1].blocking = 1;
  EXPECT_EQ(preemptive(tasks)[1].quality, Quality::kBound);
  EXPECT_EQ(preemptive(tasks)[0], (Response{Quality::kExact, 1}));
}

// Each set that passes a test meets its deadlines by analysis. The hyperbolic test passes more.
TEST(LoadTests, PassOnlySetsInTime) {
  RandomStream stream({.seed = 13});
  int by_liu_layland = 0, by_hyperbolic = 0;
  for (int set = 0; set < 2'000; ++set) {
    std::vector<TaskTimes> tasks = small_set(stream, static_cast<std::size_t>(stream.integer(1, 4)), 30);
    std::sort(tasks.begin(), tasks.end(), [](const TaskTimes& a, const TaskTimes& b) { return a.period < b.period; });
    const bool hyperbolic = passes_hyperbolic(tasks);
    ASSERT_TRUE(hyperbolic || !passes_liu_layland(tasks));
    by_liu_layland += passes_liu_layland(tasks) ? 1 : 0;
    by_hyperbolic += hyperbolic ? 1 : 0;
    if (!hyperbolic) continue;
    const std::vector<Response> responses = preemptive(tasks);
    for (std::size_t i = 0; i < tasks.size(); ++i) ASSERT_TRUE(responses[i].keeps(tasks[i].deadline));
  }
  EXPECT_GT(by_liu_layland, 100);
  EXPECT_GT(by_hyperbolic, by_liu_layland);
}

TEST(LoadTests, AtTheirLimits) {
  EXPECT_TRUE(passes_hyperbolic(std::vector<TaskTimes>{small_task(1, 2), small_task(1, 3)})) << "3/2 * 4/3 = 2";
  EXPECT_FALSE(passes_hyperbolic(std::vector<TaskTimes>{small_task(1, 2), small_task(333'334, 1'000'000)}));
  EXPECT_TRUE(passes_liu_layland(std::vector<TaskTimes>{small_task(5, 5)}));
  EXPECT_FALSE(passes_liu_layland(std::vector<TaskTimes>{small_task(1, 4, 1)})) << "jitter";
  EXPECT_FALSE(passes_hyperbolic(std::vector<TaskTimes>{small_task(1, 4, 1)}));
  EXPECT_DOUBLE_EQ(utilisation(std::vector<TaskTimes>{small_task(1, 2), small_task(1, 4)}), 0.75);
}

}  // namespace
}  // namespace ttf::schedules::timing::response
