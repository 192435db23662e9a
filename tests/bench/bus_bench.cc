// The speed of the simulated FlexRay: controllers without hosts, every static slot owned and sent on both
// channels.
//
// Items per second are static slots of the schedule. A slot has one frame on channel A and one on channel B.
// Each is encoded, put on its way, and received, judged and stored by every other node.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "core/random.h"
#include "sim/engine/bus_simulation.h"
#include "tests/bench/yardstick.h"
#include "tests/sim/engine/bus_clusters.h"

namespace ttf::sim {
namespace {

// All 64 static slots of a 5 ms cycle are owned, by the nodes in turn.
schedules::model::Cluster full_cluster(int nodes) {
  schedules::model::Cluster cluster = engine::bus_cluster(nodes, 3, nodes < 15 ? nodes : 15);
  for (int slot = nodes + 1; slot <= cluster.flexray.gNumberOfStaticSlots; ++slot)
    cluster.frames.push_back(
        {slot, schedules::model::Channels::kAB, 0, 1, static_cast<NodeId>((slot - 1) % nodes), kNoPdu, 0, 0});
  return cluster;
}

struct Problems final : bus::controller::ControllerEvents {
  int count = 0;
  void slot_problem(std::int64_t, int, schedules::model::Channel, bus::controller::SlotStatus, Microticks) override {
    ++count;
  }
  bool wants_bytes() const override { return false; }
};

void report(benchmark::State& state, const schedules::model::Cluster& cluster, int slots_per_cycle,
            std::int64_t cycles) {
  state.SetItemsProcessed(cycles * slots_per_cycle);
  state.counters["x real time"] =
      benchmark::Counter(static_cast<double>(cycles) * cluster.cycle().seconds(), benchmark::Counter::kIsRate);
}

void run(benchmark::State& state, const schedules::model::Cluster& cluster, int slots_per_cycle,
         bool transparent = false) {
  std::vector<engine::BusNode> nodes;
  std::vector<Problems> seen(cluster.nodes.size());
  std::vector<bus::controller::ControllerEvents*> events;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    RandomStream draw({1, 0, Purpose::kClockDrift, static_cast<std::uint16_t>(n), 0});
    const std::int64_t ppb = draw.integer(-100'000, 100'000);
    engine::BusNode node{timebase::Oscillator(25'000, ppb, draw.integer(0, 24'999))};
    node.clock = bus::controller::InitialClock{node.oscillator.ticks_at(TrueTime{1'000'000}),
                                               static_cast<int>(ppb * engine::kMicroPerCycle / 1'000'000'000)};
    nodes.push_back(node);
    events.push_back(&seen[n]);
  }
  engine::BusSimulation simulation(cluster, std::move(nodes), std::move(events));
  simulation.medium().set_transparent(transparent);
  simulation.run_until(TrueTime{1'000'000} + cluster.cycle() * 10);
  constexpr std::int64_t kCycles = 20;
  for (auto _ : state) simulation.run_until(simulation.now() + cluster.cycle() * kCycles);
  for (const Problems& one : seen)
    if (one.count > 0) state.SkipWithError("a slot had a problem");
  report(state, cluster, slots_per_cycle, state.iterations() * kCycles);
}

void StaticSlots(benchmark::State& state) {
  const schedules::model::Cluster cluster = full_cluster(static_cast<int>(state.range(0)));
  run(state, cluster, cluster.flexray.gNumberOfStaticSlots, state.range(1) != 0);
}
BENCHMARK(StaticSlots)
    ->ArgsProduct({{4, 16}, {0, 1}})
    ->ArgNames({"nodes", "transparent"})
    ->Unit(benchmark::kMicrosecond);

// One slot per node, as in start-up tests and fault campaigns: unassigned slots cost nothing.
void OneSlotPerNode(benchmark::State& state) {
  const int nodes = static_cast<int>(state.range(0));
  const schedules::model::Cluster cluster = engine::bus_cluster(nodes, 3, nodes < 15 ? nodes : 15);
  run(state, cluster, nodes, state.range(1) != 0);
}
BENCHMARK(OneSlotPerNode)
    ->ArgsProduct({{4, 6, 16}, {0, 1}})
    ->ArgNames({"nodes", "transparent"})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ttf::sim

BENCHMARK_MAIN();
