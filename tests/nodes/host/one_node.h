// One node on a silent bus, its tasks made for a test: 1 ms cycles of 1000 macroticks of 40 microticks of 25
// ns.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "nodes/host/executive.h"
#include "tests/bus/alone.h"

namespace ttf::nodes::host {

// A step scripted by the test.
class Scripted final : public Step {
 public:
  explicit Scripted(std::function<void(ttf::nodes::host::StepContext&)> what = [](StepContext&) {})
      : what_(std::move(what)) {}
  void run(StepContext& context) override { what_(context); }

 private:
  std::function<void(ttf::nodes::host::StepContext&)> what_;
};

struct NoLines final : SensorLines {
  void trigger(SensorId) override {}
  void strobe(SensorId, std::uint32_t) override {}
};

struct Runs final : recording::records::Sink {
  using recording::records::Sink::on;
  struct Run {
    int task;
    std::int64_t activated, start, end;  // us of true time from the start of cycle 0
    bool deadline_met;
    bool operator==(const Run&) const = default;
  };
  struct Hop {
    recording::records::Hop what;
    std::uint32_t sequence;
    std::int64_t at;
  };
  std::vector<Run> runs;
  std::vector<Hop> hops;

  // Cycle 0 starts at microtick 1000.
  static std::int64_t us(TrueTime t) { return (t.ns - 25'000) / 1000; }
  void on(const recording::records::TaskRun& run) override {
    runs.push_back(
        {run.task, us(run.activated.true_time), us(run.start.true_time), us(run.end.true_time), run.deadline_met});
  }
  void on(const recording::records::ListHop& hop) override {
    hops.push_back({hop.hop, hop.sequence, us(hop.stamp.true_time)});
  }
};

// [us], always the worst case.
inline schedules::model::Task task(std::string name, std::int64_t execution, std::int64_t deadline = 100'000) {
  schedules::model::Task t;
  t.name = std::move(name);
  t.best_case = t.worst_case = Duration::microseconds(execution);
  t.draw = schedules::model::ExecutionDraw::kWorst;
  t.deadline = Duration::microseconds(deadline);
  return t;
}
inline schedules::model::Task at(int macrotick, schedules::model::Task t, int repetition = 1) {
  t.activation = {schedules::model::ActivationKind::kTime, {0, repetition, Macroticks{macrotick}}, "", kNoSensor, ""};
  return t;
}
inline schedules::model::Task after(std::string other, schedules::model::Task t) {
  t.activation = {schedules::model::ActivationKind::kCompletion, {}, "", kNoSensor, std::move(other)};
  return t;
}

struct OneNode {
  schedules::model::Cluster cluster = bus::small_cluster(4);
  bus::NoPort port;
  NoLines lines;
  Runs recorded;
  std::unique_ptr<Executive> executive;

  explicit OneNode(std::vector<schedules::model::Task> tasks, std::vector<std::shared_ptr<Step>> steps = {}) {
    while (steps.size() < tasks.size()) steps.push_back(std::make_shared<Scripted>());
    cluster.nodes[0].tasks = std::move(tasks);
    const ExecutiveConfig config{
        &cluster, NodeId{0}, timebase::Oscillator(25'000, 0, 0), bus::controller::InitialClock{{1000}, 0}, 1, 0, {}};
    executive = std::make_unique<Executive>(config, std::move(steps), &port, std::vector<bus::ports::CanPort*>{}, lines,
                                            recorded);
  }
  // From event to event, as an engine does.
  void run_to(std::int64_t cycle, std::int64_t macrotick = 0) {
    const Microticks end = bus::Alone::at(cycle, macrotick);
    for (Microticks next = executive->next_event(); next <= end; next = executive->next_event()) {
      executive->advance(next);
      ASSERT_GT(executive->next_event(), next) << "L1";
    }
  }
};

}  // namespace ttf::nodes::host
