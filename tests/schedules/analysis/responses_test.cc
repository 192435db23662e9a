#include "schedules/analysis/responses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "core/random.h"
#include "schedules/analysis/slot_groups.h"
#include "tests/schedules/durations.h"

namespace ttf::schedules::analysis {
namespace {

model::Task task(std::string name, model::ActivationKind kind, Duration execution) {
  model::Task one;
  one.name = std::move(name);
  one.activation.kind = kind;
  one.best_case = one.worst_case = execution;
  return one;
}

// One node on FlexRay, cycle of 5 ms, with clocks that need no correction.
model::Cluster cluster_of(std::vector<model::Task> tasks) {
  model::Cluster cluster;
  cluster.nodes.resize(1);
  cluster.nodes[0].flexray.emplace();
  cluster.nodes[0].drift_ppb = 0;
  cluster.nodes[0].tasks = std::move(tasks);
  return cluster;
}

model::Task timed_task(std::string name, model::CycleInstant at, Duration execution) {
  model::Task one = task(std::move(name), model::ActivationKind::kTime, execution);
  one.activation.at = at;
  return one;
}

// Activated by a free-running sensor of this period, which is added.
void add_sporadic(model::Cluster& cluster, std::string name, Duration period, Duration execution) {
  model::Sensor sensor;
  sensor.period = period;
  cluster.sensors.push_back(sensor);
  model::Task one = task(std::move(name), model::ActivationKind::kSensor, execution);
  one.activation.sensor = static_cast<SensorId>(cluster.sensors.size() - 1);
  cluster.nodes[0].tasks.push_back(one);
}

model::Task after(std::string name, std::string previous, Duration execution) {
  model::Task one = task(std::move(name), model::ActivationKind::kCompletion, execution);
  one.activation.after = std::move(previous);
  return one;
}

std::vector<TaskResponse> responses(const model::Cluster& cluster) {
  const auto found = worst_responses(cluster, NodeId{0});
  EXPECT_TRUE(found.has_value());
  return found ? *found : std::vector<TaskResponse>(cluster.nodes[0].tasks.size());
}

TEST(Responses, OfATaskAloneIsItsExecution) {
  const auto r = responses(cluster_of({timed_task("a", {0, 2, Macroticks{100}}, ms(4))}));
  EXPECT_EQ(r[0].worst, ms(4));
  EXPECT_NEAR(static_cast<double>(r[0].gap->ns), 10e6, 200);
  EXPECT_NEAR(static_cast<double>(r[0].written->ns), 10e6, 200);
}

TEST(Responses, TasksOfMessagesWaitForEachOther) {
  model::Cluster cluster = cluster_of({});
  add_sporadic(cluster, "a", ms(20), us(200));
  add_sporadic(cluster, "b", ms(30), us(300));
  const auto r = responses(cluster);
  EXPECT_EQ(r[0].worst, us(500));
  EXPECT_EQ(r[1].worst, us(500));
  EXPECT_EQ(r[0].gap, ms(20) - Duration{100});
  EXPECT_EQ(r[0].written, ms(20) - Duration{100} - us(300));  // one late, the next immediately
}

// One of 0.5 ms comes every 2 ms. Two of them and the first task precede the second, which is 2.1 ms later.
//
//   first  |========|
//   second           ^activated  |====|
//   short  |==|      |==|
TEST(Responses, AMessageDelaysATaskIntoTheNextOne) {
  model::Cluster cluster = cluster_of(
      {timed_task("first", {0, 2, Macroticks{0}}, ms(2)), timed_task("second", {0, 2, Macroticks{2100}}, ms(1))});
  add_sporadic(cluster, "short", ms(2), us(500));
  const auto r = responses(cluster);
  EXPECT_EQ(r[0].worst, us(2500));
  EXPECT_NEAR(static_cast<double>(r[1].worst.ns), 1.9e6, 200);
  EXPECT_GE(r[1].worst, us(1900));
}

TEST(Responses, AChainsTaskStartsAtTheEndOfTheOneBefore) {
  model::Cluster cluster =
      cluster_of({timed_task("fuse", {0, 2, Macroticks{0}}, ms(4)), after("publish", "fuse", us(500))});
  EXPECT_EQ(responses(cluster)[0].worst, ms(4));
  EXPECT_EQ(responses(cluster)[1].worst, us(500));
  // Another one that time activates between, and one far behind.
  cluster.nodes[0].tasks.push_back(timed_task("between", {0, 2, Macroticks{3900}}, ms(1)));
  EXPECT_EQ(responses(cluster)[1].worst, us(1500));
  EXPECT_NEAR(static_cast<double>(responses(cluster)[2].worst.ns), 1.6e6, 200);  // publish counted before it
  cluster.nodes[0].tasks[2].activation.at = {1, 2, Macroticks{0}};
  EXPECT_EQ(responses(cluster)[1].worst, us(500));
  // A message may come at any time.
  add_sporadic(cluster, "message", ms(40), us(700));
  EXPECT_EQ(responses(cluster)[0].worst, us(4700));
  EXPECT_EQ(responses(cluster)[1].worst, us(1200));
}

TEST(Responses, MoreWorkThanTimeHasNoBound) {
  model::Cluster cluster = cluster_of({});
  add_sporadic(cluster, "a", ms(10), ms(6));
  EXPECT_TRUE(worst_responses(cluster, NodeId{0}).has_value());
  add_sporadic(cluster, "b", ms(10), ms(6));
  EXPECT_FALSE(worst_responses(cluster, NodeId{0}).has_value());
}

TEST(Responses, CorrectionsBringInstantsCloser) {
  model::Cluster cluster = cluster_of(
      {timed_task("first", {0, 2, Macroticks{0}}, ms(2)), timed_task("second", {0, 2, Macroticks{2000}}, ms(1))});
  model::NodeParameters& p = *cluster.nodes[0].flexray;
  p.pRateCorrectionOut = 600;    // of 200000: 6 us in 2 ms
  p.pOffsetCorrectionOut = 400;  // 10 us
  EXPECT_NEAR(static_cast<double>(responses(cluster)[1].worst.ns), 1e6 + 16e3, 200);
  EXPECT_NEAR(static_cast<double>(responses(cluster)[0].gap->ns), 10e6 - 30e3 - 20e3, 200);
}

// The shortest distance over the cycles, rather than the shortest repetition: cycles 1, 9, 17 .. and 2, 10,
// 18 ..
TEST(SlotGaps, AreBetweenTheCyclesThatHaveTheList) {
  model::Cluster cluster = cluster_of({});
  cluster.flexray.gNumberOfStaticSlots = 24;
  const model::FrameSlot one{22, model::Channels::kAB, 1, 8, NodeId{0}, PduId{0}, 0, 0};
  model::FrameSlot other = one;
  other.base_cycle = 2;
  cluster.frames = {one};
  EXPECT_EQ(shortest_slot_gap(cluster, PduId{0})->gap, ms(40));
  cluster.frames = {one, other};
  EXPECT_EQ(shortest_slot_gap(cluster, PduId{0})->gap, ms(5));
  cluster.frames[1].base_cycle = 7;
  cluster.frames[1].slot = 12;  // 840 us earlier in its cycle
  EXPECT_EQ(shortest_slot_gap(cluster, PduId{0})->gap, ms(10) + us(840));
  cluster.frames[1] = {24, model::Channels::kAB, 1, 8, NodeId{0}, PduId{0}, 1, 0};
  EXPECT_EQ(shortest_slot_gap(cluster, PduId{0})->gap, ms(40));
  EXPECT_EQ(shortest_slot_gap(cluster, PduId{0})->spread, us(3 * 84));
  EXPECT_FALSE(shortest_slot_gap(cluster, PduId{1}).has_value());
}

// An oracle: the queue itself, run for many drawn phases and executions. One entry per task.
struct Queue {
  const model::Cluster& cluster;
  RandomStream& draws;
  std::vector<Duration> worst;

  struct Job {
    std::size_t task;
    std::int64_t activated;
  };

  void run(std::int64_t end) {
    const auto& tasks = cluster.nodes[0].tasks;
    worst.assign(tasks.size(), Duration{});
    std::vector<Job> coming;
    for (std::size_t t = 0; t < tasks.size(); ++t) {
      const model::Activation& activation = tasks[t].activation;
      if (activation.kind == model::ActivationKind::kTime)
        for (std::int64_t cycle = activation.at.base_cycle; cycle * 5'000'000 < end; cycle += activation.at.repetition)
          coming.push_back({t, time_of(cluster.flexray, cycle, activation.at.offset).ns});
      if (activation.kind != model::ActivationKind::kSensor) continue;
      const std::int64_t period = cluster.sensor(activation.sensor).period.ns;
      // Often at the shortest distance, and often at an instant of time.
      std::int64_t at = draws.integer(0, 1) == 0 ? draws.integer(0, 9) * 5'000'000 : draws.integer(0, period);
      for (; at < end; at += period + (draws.integer(0, 3) == 0 ? draws.integer(0, period) : 0))
        coming.push_back({t, at});
    }
    for (Job& job : coming) job.activated = std::max<std::int64_t>(0, job.activated);
    std::stable_sort(coming.begin(), coming.end(),
                     [](const Job& a, const Job& b) { return a.activated < b.activated; });
    std::deque<Job> ready;
    std::int64_t now = 0;
    for (std::size_t next = 0; next < coming.size() || !ready.empty();) {
      if (ready.empty()) now = std::max(now, coming[next].activated);
      for (; next < coming.size() && coming[next].activated <= now; ++next) ready.push_back(coming[next]);
      const Job job = ready.front();
      ready.pop_front();
      const model::Task& running = tasks[job.task];
      now +=
          draws.integer(0, 2) == 0 ? draws.integer(running.best_case.ns, running.worst_case.ns) : running.worst_case.ns;
      for (; next < coming.size() && coming[next].activated <= now; ++next) ready.push_back(coming[next]);
      worst[job.task] = std::max(worst[job.task], Duration{now - job.activated});
      for (std::size_t t = 0; t < tasks.size(); ++t)
        if (tasks[t].activation.kind == model::ActivationKind::kCompletion && tasks[t].activation.after == running.name)
          ready.push_back({t, now});
    }
  }
};

TEST(Responses, NoDrawnQueueIsEverSlower) {
  RandomStream stream({11, 0, Purpose::kTest, 0, 0});
  int proved = 0;
  double closest_first = 0, closest_chained = 0;
  for (int run = 0; run < 300; ++run) {
    model::Cluster cluster = cluster_of({});
    auto& tasks = cluster.nodes[0].tasks;
    const auto name = [&] { return std::string(1, static_cast<char>('a' + tasks.size())); };
    if (stream.integer(0, 3) != 0)
      tasks.push_back(timed_task(name(), {0, 2, Macroticks{stream.integer(0, 900)}}, us(1500)));
    if (stream.integer(0, 1) != 0)
      tasks.push_back(timed_task(name(), {0, 2, Macroticks{stream.integer(2400, 4900)}}, us(1000)));
    for (std::int64_t n = stream.integer(tasks.empty() ? 1 : 0, 2); n > 0; --n)
      add_sporadic(cluster, name(), us(static_cast<int>(stream.integer(6, 30)) * 1000),
                   us(static_cast<int>(stream.integer(2, 15)) * 100));
    for (std::int64_t n = stream.integer(0, 2); n > 0; --n) {
      const auto previous = static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(tasks.size()) - 1));
      tasks.push_back(after(name(), tasks[previous].name, us(static_cast<int>(stream.integer(2, 10)) * 100)));
    }
    for (model::Task& one : tasks) one.best_case = one.worst_case * stream.integer(1, 4);
    for (model::Task& one : tasks) one.best_case = {one.best_case.ns / 4};
    const auto bounds = worst_responses(cluster, NodeId{0});
    if (!bounds || std::any_of(bounds->begin(), bounds->end(), [](const auto& r) { return r.worst >= *r.gap; }))
      continue;
    ++proved;
    Queue queue{cluster, stream, {}};
    for (int drawn = 0; drawn < 20; ++drawn) {
      queue.run(1'000'000'000);
      for (std::size_t t = 0; t < tasks.size(); ++t) {
        EXPECT_LE(queue.worst[t], (*bounds)[t].worst) << "run " << run << " task " << tasks[t].name;
        double& closest =
            tasks[t].activation.kind == model::ActivationKind::kCompletion ? closest_chained : closest_first;
        if ((*bounds)[t].worst > tasks[t].worst_case)
          closest = std::max(closest, queue.worst[t].seconds() / (*bounds)[t].worst.seconds());
      }
    }
  }
  EXPECT_GT(proved, 150);
  // And the bounds are no empty words: some are met.
  EXPECT_GT(closest_first, 0.999);
  EXPECT_GT(closest_chained, 0.9);
}

}  // namespace
}  // namespace ttf::schedules::analysis
