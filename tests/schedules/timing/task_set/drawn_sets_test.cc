// Drawn task sets are compared with processors that work tick by tick.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/random.h"
#include "schedules/timing/task_set/reader.h"
#include "schedules/timing/task_set/verdict.h"
#include "tests/schedules/timing/chain/data_flow.h"
#include "tests/schedules/timing/task_set/ticks.h"

namespace ttf::schedules::timing::task_set {
namespace {

constexpr std::int64_t kHyperperiod = 120;
constexpr std::int64_t kTick = 1000;  // a tick of the simulation is a microsecond of the file

// Tasks on two processors, and one chain over some of them. With `activations`, stages may activate the next one.
class DrawnSet {
 public:
  DrawnSet(std::uint32_t index, bool activations, bool preemptive)
      : stream({.seed = 9, .purpose = Purpose::kTest, .index = index}), preemptive_(preemptive) {
    const std::int64_t count = stream.integer(2, 6);
    for (std::int64_t t = 0; t < count; ++t) tasks.push_back(task(static_cast<int>(t)));
    for (std::size_t t = 0; t < tasks.size(); ++t) stages.push_back(t);
    for (std::size_t t = stages.size(); t-- > 1;)
      std::swap(stages[t], stages[static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(t)))]);
    stages.resize(static_cast<std::size_t>(stream.integer(1, std::min<std::int64_t>(count, 4))));
    for (std::size_t s = 1; activations && s < stages.size(); ++s)
      if (stream.integer(0, 1) == 1) {
        tasks[stages[s]].activator = stages[s - 1];
        tasks[stages[s]].period = tasks[stages[s - 1]].period;
      }
  }

  bool fits() const {
    std::array<double, 2> load{};
    for (const TickTask& task : tasks)
      load[task.processor] += static_cast<double>(task.worst) / static_cast<double>(task.period);
    return load[0] < 0.97 && load[1] < 0.97;
  }

  std::string csv(bool offsets) const {
    const auto us = [](std::int64_t ticks) { return std::to_string(ticks) + " us"; };
    std::string text =
        std::string("processor,p0,preemptive\nprocessor,p1,") + (preemptive_ ? "preemptive\n" : "non_preemptive\n");
    for (std::size_t t = 0; t < tasks.size(); ++t) {
      const TickTask& task = tasks[t];
      const bool event = task.activator.has_value();
      text += "task,t" + std::to_string(t) + ",p" + std::to_string(task.processor) + "," +
              (event ? "" : us(task.period)) + "," + (event || !offsets ? "" : us(task.offset)) + ",," + us(task.best) +
              "," + us(task.worst) + ",1 s," + std::to_string(task.priority) + (event ? ",event" : ",implicit") + "\n";
    }
    text += "chain,c,";
    for (std::size_t s = 0; s < stages.size(); ++s) text += (s > 0 ? " > t" : "t") + std::to_string(stages[s]);
    return text + "\n";
  }

  std::vector<TickTask> tasks;
  std::vector<std::size_t> stages;
  RandomStream stream;

 private:
  TickTask task(int priority) {
    constexpr std::array<std::int64_t, 8> kPeriods{4, 5, 6, 8, 10, 12, 15, 20};
    TickTask task;
    task.processor = static_cast<std::size_t>(stream.integer(0, 1));
    task.priority = priority;
    task.preemptive = task.processor == 0 || preemptive_;
    task.period = kPeriods[static_cast<std::size_t>(stream.integer(0, 7))];
    task.offset = stream.integer(0, task.period - 1);
    task.worst = stream.integer(1, 4);
    task.best = stream.integer(1, task.worst);
    return task;
  }

  bool preemptive_;
};

using Jobs = std::vector<std::vector<TickJob>>;

// The times of data that go through the chain in ticks, as nanoseconds.
chain::FlowTimes ticked(const DrawnSet& set, const Jobs& jobs) {
  std::vector<chain::FlowStage> flow;
  for (std::size_t s = 0; s < set.stages.size(); ++s) {
    chain::FlowStage stage{.activated = s > 0 && set.tasks[set.stages[s]].activator.has_value(), .jobs = {}};
    for (const TickJob& job : jobs[set.stages[s]])
      stage.jobs.push_back({.reads = Duration{job.start * kTick}, .writes = Duration{job.end * kTick}});
    flow.push_back(stage);
  }
  return chain::DataFlow(flow, 4 * kHyperperiod * kTick, 5 * kHyperperiod * kTick).times();
}

Jobs ticks_of(DrawnSet& set, bool drawn) {
  return Ticks(set.tasks, drawn ? &set.stream : nullptr).run(2, 9 * kHyperperiod);
}

void expect_chain_below(const chain::FlowTimes& some, const Verdict& verdict, std::uint32_t index) {
  const chain::EndToEnd& bound = *verdict.chains[0].times;
  ASSERT_LE(some.reaction, bound.reaction.time.ns) << "set " << index;
  ASSERT_LE(some.reduced_reaction, bound.reduced_reaction.time.ns) << "set " << index;
  ASSERT_LE(some.age, bound.age->time.ns) << "set " << index;
  ASSERT_LE(some.reduced_age, bound.reduced_age->time.ns) << "set " << index;
}

// The time from the release of the first activator, and that from its own release.
void expect_responses_below(const DrawnSet& set, const Jobs& jobs, const Verdict& verdict, std::uint32_t index) {
  for (std::size_t t = 0; t < jobs.size(); ++t) {
    std::size_t root = t;
    while (set.tasks[root].activator) root = *set.tasks[root].activator;
    const TaskTiming& timing = verdict.responses.tasks[t];
    for (std::size_t j = 0; j < jobs[t].size(); ++j) {
      const TickJob& job = jobs[t][j];
      ASSERT_LE((job.end - jobs[root][j].release) * kTick, timing.longest.ns) << "set " << index << ", task " << t;
      ASSERT_GE((job.end - jobs[root][j].release) * kTick, timing.shortest.ns) << "set " << index << ", task " << t;
      ASSERT_LE((job.end - job.release) * kTick, timing.response.longest) << "set " << index << ", task " << t;
    }
  }
}

Duration davare(const DrawnSet& set, const Verdict& verdict) {
  Duration sum{};
  for (const std::size_t t : set.stages)
    sum += Duration{set.tasks[t].period * kTick + verdict.responses.tasks[t].response.longest};
  return sum;
}

// All offsets are known, and the best case is the worst. So the times are those of the ticks.
TEST(DrawnSets, KnownOffsetsAreExact) {
  std::size_t judged = 0;
  for (std::uint32_t index = 0; index < 600; ++index) {
    DrawnSet set(index, false, true);
    if (!set.fits()) continue;
    for (TickTask& task : set.tasks) task.best = task.worst;
    const Verdict verdict = verdict_on(parse_task_set(set.csv(true), "drawn.csv"));
    ASSERT_TRUE(verdict.chains[0].times) << "set " << index << ": " << verdict.chains[0].why_none;
    const chain::EndToEnd& found = *verdict.chains[0].times;
    const chain::FlowTimes times{.reaction = found.reaction.time.ns,
                                 .reduced_reaction = found.reduced_reaction.time.ns,
                                 .age = found.age->time.ns,
                                 .reduced_age = found.reduced_age->time.ns};
    ASSERT_EQ(times, ticked(set, ticks_of(set, false))) << "set " << index;
    ASSERT_TRUE(found.exact);
    ASSERT_EQ(times.reaction, times.age);  // MRT = MDA
    ++judged;
  }
  EXPECT_GT(judged, 300U);
}

// Work is drawn, first at the offsets of the file, then at others. Stages activate each other in odd sets. One
// processor does not preempt where index % 4 >= 2.
TEST(DrawnSets, VaryingWorkStaysBelow) {
  std::size_t judged = 0;
  for (std::uint32_t index = 0; index < 600; ++index) {
    DrawnSet set(index, index % 2 == 1, index % 4 < 2);
    if (!set.fits()) continue;
    const Verdict known = verdict_on(parse_task_set(set.csv(true), "drawn.csv"));
    const Verdict unknown = verdict_on(parse_task_set(set.csv(false), "drawn.csv"));
    if (!known.chains[0].times) {  // jitters and responses of activations may feed each other without an end
      EXPECT_EQ(index % 2, 1U) << "set " << index << ": " << known.chains[0].why_none;
      continue;
    }
    ++judged;
    if (index % 2 == 0) {
      ASSERT_LE(unknown.chains[0].times->reaction.time, davare(set, unknown)) << "set " << index;
    }
    for (int draw = 0; draw < 3; ++draw) {
      const Jobs jobs = ticks_of(set, true);
      const chain::FlowTimes some = ticked(set, jobs);
      for (const Verdict* const verdict : {&known, &unknown}) {
        if (verdict == &known && draw > 0) continue;
        expect_chain_below(some, *verdict, index);
        expect_responses_below(set, jobs, *verdict, index);
        if (HasFatalFailure()) return;
      }
      for (TickTask& task : set.tasks) task.offset = set.stream.integer(0, task.period - 1);
    }
  }
  EXPECT_GT(judged, 300U);
}

}  // namespace
}  // namespace ttf::schedules::timing::task_set
