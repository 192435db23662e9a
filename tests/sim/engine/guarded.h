// Clusters on a star, with or without guardians: their start-up, and the nodes' and guardians' reports. For
// tests of the guardian.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "core/random.h"
#include "sim/engine/bus_simulation.h"
#include "tests/sim/engine/bus_clusters.h"

namespace ttf::sim::engine {

inline constexpr std::array kBothChannels = {schedules::model::Channel::kA, schedules::model::Channel::kB};

// bus_cluster() on a star.
inline schedules::model::Cluster star_cluster(int nodes, int coldstart, int sync, bool guardian = true) {
  schedules::model::Cluster cluster = bus_cluster(nodes, coldstart, sync);
  cluster.topology = schedules::model::Topology::kStar;
  cluster.guardian = guardian;
  return cluster;
}

// A node's report: state changes, and the slots with errors or without frames.
struct NodeLog final : bus::controller::ControllerEvents {
  StateLog states;
  std::map<int, std::uint64_t> problems;                                       // by slot, 0: outside every slot
  std::set<std::tuple<std::int64_t, int, schedules::model::Channel>> refused;  // cycle, slot
  void state_changed(bus::poc::PocKind from, const bus::poc::PocStep& step, Microticks at) override {
    states.state_changed(from, step, at);
  }
  void cycle_started(std::int64_t cycle, Microticks at) override { states.cycle_started(cycle, at); }
  void slot_problem(std::int64_t cycle, int slot, schedules::model::Channel channel, bus::controller::SlotStatus,
                    Microticks) override {
    ++problems[slot];
    refused.insert({cycle, slot, channel});
  }
  bool left_active() const {
    return std::any_of(states.changes.begin(), states.changes.end(),
                       [](const StateLog::Change& change) { return change.from == bus::poc::PocKind::kNormalActive; });
  }
};

struct Guarded {
  schedules::model::Cluster cluster;
  std::vector<std::unique_ptr<NodeLog>> logs;
  std::unique_ptr<BusSimulation> simulation;

  // Clocks of nodes and guardians are drawn. `view`: the schedule of node 0.
  Guarded(schedules::model::Cluster made, const std::vector<TrueTime>& power_on, std::uint64_t seed,
          const schedules::model::Cluster* view = nullptr)
      : cluster(std::move(made)) {
    std::vector<BusNode> nodes;
    std::vector<bus::controller::ControllerEvents*> events;
    for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
      nodes.push_back({oscillator(seed, n), power_on[n], std::nullopt, n == 0 ? view : nullptr});
      logs.push_back(std::make_unique<NodeLog>());
      events.push_back(logs.back().get());
    }
    simulation = std::make_unique<BusSimulation>(
        cluster, std::move(nodes), std::move(events),
        std::vector{oscillator(seed, cluster.nodes.size()), oscillator(seed, cluster.nodes.size() + 1)});
  }
  // All together, or at drawn times.
  Guarded(const schedules::model::Cluster& made, std::uint64_t seed, Duration within = {},
          const schedules::model::Cluster* view = nullptr)
      : Guarded(made, delays(made.nodes.size(), within, seed), seed, view) {}

  static timebase::Oscillator oscillator(std::uint64_t seed, std::size_t entity) {
    RandomStream draw({seed, 0, Purpose::kClockDrift, static_cast<std::uint16_t>(entity), 0});
    const std::int64_t ppb = draw.integer(-1'500'000, 1'500'000);
    return {25'000, ppb, draw.integer(0, 24'999)};
  }
  static std::vector<TrueTime> delays(std::size_t nodes, Duration within, std::uint64_t seed) {
    RandomStream draw({seed, 0, Purpose::kTest, 0, 0});
    std::vector<TrueTime> at;
    for (std::size_t n = 0; n < nodes; ++n) at.push_back(TrueTime{draw.integer(0, within.ns)});
    return at;
  }

  void run(Duration length) { simulation->run_until(simulation->now() + length); }
  void run_cycles(int cycles) { run(cluster.cycle() * cycles); }
  bus::poc::PocKind kind(std::size_t node) const {
    return simulation->controller(static_cast<NodeId>(node)).state().kind;
  }
  // From node `first` on.
  bool all_active(std::size_t first = 0) const {
    for (std::size_t n = first; n < logs.size(); ++n)
      if (kind(n) != bus::poc::PocKind::kNormalActive) return false;
    return true;
  }
  bool none_left_active(std::size_t first = 0) const {
    for (std::size_t n = first; n < logs.size(); ++n)
      if (logs[n]->left_active()) return false;
    return true;
  }
  // Problems in slots of the nodes from `first` on and outside every slot, as these nodes see them. (Node n
  // sends in slot n + 1.)
  std::uint64_t problems(std::size_t first = 0) const {
    std::uint64_t sum = 0;
    for (std::size_t n = first; n < logs.size(); ++n)
      for (const auto& [slot, times] : logs[n]->problems)
        if (slot == 0 || slot > static_cast<int>(first)) sum += times;
    return sum;
  }
  // Returns whether the nodes from `first` on agree about the slot.
  bool agree(int slot, std::size_t first) const {
    const auto seen = [&](std::size_t n) {
      std::set<std::tuple<std::int64_t, int, schedules::model::Channel>> of_slot;
      for (const auto& one : logs[n]->refused)
        if (std::get<1>(one) == slot) of_slot.insert(one);
      return of_slot;
    };
    for (std::size_t n = first + 1; n < logs.size(); ++n)
      if (seen(n) != seen(first)) return false;
    return true;
  }
  void forget() {
    for (auto& log : logs) log->problems.clear(), log->refused.clear(), log->states.changes.clear();
  }
  medium::StarCoupler& coupler(schedules::model::Channel channel) { return *simulation->coupler(channel); }
  std::uint64_t blocked(bus::guardian::GuardianReason reason) {
    return coupler(schedules::model::Channel::kA).blocked(reason) +
           coupler(schedules::model::Channel::kB).blocked(reason);
  }
};

}  // namespace ttf::sim::engine
