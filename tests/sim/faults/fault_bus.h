// Controllers without hosts on a bus with faults, and all reports of them and of the injector.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "core/random.h"
#include "faults/believed_schedule.h"
#include "faults/plan.h"
#include "sim/engine/bus_simulation.h"
#include "sim/faults/injector.h"
#include "tests/sim/engine/bus_clusters.h"

namespace ttf::sim::faults {

inline constexpr std::int64_t kCycleNs = 5'000'000;
inline constexpr auto kAnything = static_cast<bus::controller::SlotStatus>(0xff);  // every bit of a slot status
constexpr bus::controller::SlotStatus anything_but(bus::controller::SlotStatus bits) {
  return static_cast<bus::controller::SlotStatus>(0xff & ~static_cast<unsigned>(bits));
}

// A controller's reports.
struct Said final : bus::controller::ControllerEvents {
  struct Problem {
    std::int64_t cycle = 0;
    int slot = 0;
    schedules::model::Channel channel{};
    bus::controller::SlotStatus status{};
  };
  std::vector<Problem> problems;
  std::vector<bus::poc::PocKind> states;
  std::vector<std::string> all;
  bool rate_limited = false, clock_missing = false;
  std::int64_t lists = 0;

  void slot_problem(std::int64_t cycle, int slot, schedules::model::Channel channel, bus::controller::SlotStatus status,
                    Microticks at) override {
    problems.push_back({cycle, slot, channel, status});
    all.push_back(fmt::format("{} cycle {} slot {} channel {} status {}", at.value, cycle, slot, index_of(channel),
                              static_cast<unsigned>(status)));
  }
  void state_changed(bus::poc::PocKind from, const bus::poc::PocStep& step, Microticks at) override {
    states.push_back(step.next.kind);
    all.push_back(fmt::format("{} from {} to {}", at.value, static_cast<int>(from), static_cast<int>(step.next.kind)));
  }
  void clock_corrected(std::int64_t cycle, const timebase::Correction& offset, const timebase::Correction& rate,
                       Microticks at) override {
    rate_limited |= rate.limit_reached;
    clock_missing |= offset.missing || rate.missing;
    all.push_back(fmt::format("{} cycle {} offset {} rate {}", at.value, cycle, offset.value, rate.value));
  }
  // How often a slot had one of these problems.
  int count(int slot, bus::controller::SlotStatus status) const {
    int times = 0;
    for (const Problem& problem : problems) times += problem.slot == slot && has(problem.status, status) ? 1 : 0;
    return times;
  }
};

struct FaultBusConfig {
  schedules::model::Cluster cluster = engine::bus_cluster(4, 2, 4);
  std::vector<ttf::faults::Fault> faults;
  std::uint64_t seed = 1;
  std::int64_t most_drift_ppb = 200'000;
  bool cold = false;   // all powered on at time zero; else integrated, cycle 0 beginning at a millisecond
  bool inject = true;  // false: no disturbance
};
inline FaultBusConfig with(std::vector<ttf::faults::Fault> faults) {
  FaultBusConfig config;
  config.faults = std::move(faults);
  return config;
}

class FaultBus final : public recording::records::Sink {
 public:
  explicit FaultBus(FaultBusConfig config)
      : config_(std::move(config)), plan_{"", config_.faults}, believed_(plan_, config_.cluster) {
    std::vector<engine::BusNode> nodes;
    std::vector<bus::controller::ControllerEvents*> events;
    for (std::size_t n = 0; n < config_.cluster.nodes.size(); ++n) {
      RandomStream draw({config_.seed, 0, Purpose::kClockDrift, static_cast<std::uint16_t>(n), 0});
      const std::int64_t phase = draw.integer(0, 24'999);
      engine::BusNode node{
          timebase::Oscillator(25'000, draw.integer(-config_.most_drift_ppb, config_.most_drift_ppb), phase)};
      if (!config_.cold) node.clock = integrated(node.oscillator);
      node.view = believed_.of(static_cast<NodeId>(n));
      nodes.push_back(node);
      said_.push_back(std::make_unique<Said>());
      events.push_back(said_.back().get());
    }
    simulation_ = std::make_unique<engine::BusSimulation>(config_.cluster, std::move(nodes), std::move(events));
    if (!config_.inject) return;
    injector_ = std::make_unique<Injector>(plan_, config_.cluster, *simulation_, config_.seed, 0, *this, origin());
    simulation_->set_disturbance(injector_.get());
  }

  // With one fault, after so many cycles.
  FaultBus(const ttf::faults::Fault& fault, int cycles) : FaultBus(FaultBusConfig{.faults = {fault}}) {
    run(5 * cycles + 1);
  }
  FaultBus(const FaultBus&) = delete;
  FaultBus& operator=(const FaultBus&) = delete;

  FaultBus& run(int milliseconds) {
    simulation_->run_until(origin() + Duration::milliseconds(milliseconds));
    return *this;
  }
  const Said& said(int node) const { return *said_[static_cast<std::size_t>(node)]; }
  bus::poc::PocKind state(int node) const { return simulation_->controller(static_cast<NodeId>(node)).state().kind; }
  engine::BusSimulation& simulation() { return *simulation_; }
  std::uint64_t acts(std::size_t fault = 0) const { return injector_->activations()[fault].times; }
  const Injector& injector() const { return *injector_; }

  struct Activity {
    TrueTime at{};
    std::uint32_t fault = 0;
    recording::records::FaultAct what{};
    NodeId node{};
    std::string kind, text;
  };
  const std::vector<Activity>& activities() const { return activities_; }
  // All reports, faults included, as one text.
  std::string everything() const {
    std::string text;
    for (std::size_t n = 0; n < said_.size(); ++n)
      for (const std::string& line : said_[n]->all) text += fmt::format("{}: {}\n", n, line);
    for (const Activity& a : activities_)
      text += fmt::format("{} fault {} {} {} {}\n", a.at.ns, a.fault, index_of(a.what), a.kind, a.text);
    return text;
  }

 private:
  TrueTime origin() const { return TrueTime{config_.cold ? 0 : 1'000'000}; }
  bus::controller::InitialClock integrated(const timebase::Oscillator& oscillator) const {
    const TrueTime start = origin();
    const std::int64_t thousand =
        (oscillator.ticks_at(start + config_.cluster.cycle() * 1000) - oscillator.ticks_at(start)).value;
    return {oscillator.ticks_at(start) + Microticks{1},
            static_cast<int>((thousand + 500) / 1000 - engine::kMicroPerCycle)};
  }
  using recording::records::Sink::on;
  void on(const recording::records::FaultActivity& activity) override {
    activities_.push_back({activity.at, activity.fault, activity.what, activity.node, std::string(activity.kind),
                           std::string(activity.text)});
  }

  FaultBusConfig config_;
  ttf::faults::FaultPlan plan_;
  ttf::faults::BelievedSchedules believed_;
  std::vector<std::unique_ptr<Said>> said_;
  std::unique_ptr<engine::BusSimulation> simulation_;
  std::unique_ptr<Injector> injector_;
  std::vector<Activity> activities_;
};

// A fault of node `node`, from cycle `from` on for `cycles` cycles, a macrotick before cycle boundaries; -1:
// to the end.
inline ttf::faults::Fault fault_of(ttf::faults::FaultKind kind, int node, int from = 10, int cycles = -1) {
  ttf::faults::Fault fault;
  fault.kind = kind;
  if (ttf::faults::has_node(kind)) fault.node = static_cast<NodeId>(node);
  fault.from = Duration{from * kCycleNs - (from > 0 ? 10'000 : 0)};
  if (cycles >= 0) fault.duration = Duration{cycles * kCycleNs};
  return fault;
}

}  // namespace ttf::sim::faults
