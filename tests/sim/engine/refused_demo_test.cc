// flexray_demo.yaml with a parameter that the check refuses, driven all the same: no cold start succeeds, or a
// restarting node disturbs the running cluster (docs/schedules/flexray_constraints.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "sim/engine/bus_simulation.h"
#include "tests/schedules/cluster_file.h"
#include "tests/sim/engine/bus_clusters.h"

namespace ttf::sim::engine {
namespace {

using bus::poc::PocKind;

constexpr std::uint32_t kDraws = 100;

// Keeps a controller's changes of state, and when its collision avoidance symbols began.
struct SymbolLog final : bus::controller::ControllerEvents {
  StateLog states;
  std::vector<Microticks> symbols;
  bool wants_bytes() const override { return false; }
  void state_changed(PocKind from, const bus::poc::PocStep& step, Microticks at) override {
    states.state_changed(from, step, at);
  }
  void symbol_sent(bus::ports::Signal signal, schedules::model::Channel, Microticks start, Microticks) override {
    if (signal == bus::ports::Signal::kCas) symbols.push_back(start);
  }
};

// The demo with `parameter: value` in the parameters of all nodes, past the checker.
schedules::model::Cluster demo(const std::string& parameter, const std::string& value) {
  std::string text = schedules::shipped_text("flexray_demo");
  if (!parameter.empty()) {
    const std::size_t at = text.find("  " + parameter + ": ") + parameter.size() + 4;
    text.replace(at, text.find_first_of(" \n", at) - at, value);
  }
  return schedules::file::parse_cluster(text, "demo.yaml");
}

bool is_refused(const schedules::model::Cluster& cluster, const std::string& parameter) {
  const std::vector<Finding> findings = schedules::check::check(cluster);
  return !findings.empty() &&
         std::ranges::all_of(findings, [&](const Finding& finding) { return finding.key.ends_with("." + parameter); });
}

// Its controllers, on drawn clocks, with supplies that come within two cycles.
struct Driven {
  schedules::model::Cluster cluster;
  std::vector<std::unique_ptr<SymbolLog>> logs;
  std::unique_ptr<BusSimulation> simulation;

  Driven(const schedules::model::Cluster& made, std::uint32_t index) : cluster(made) {
    RandomStream draw({3, index, Purpose::kTest, 79, 0});
    std::vector<BusNode> nodes;
    std::vector<bus::controller::ControllerEvents*> events;
    for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
      nodes.push_back({timebase::Oscillator{25'000, draw.integer(-1'500'000, 1'500'000), draw.integer(0, 24'999)},
                       TrueTime{draw.integer(0, 2 * cluster.cycle().ns)}});
      logs.push_back(std::make_unique<SymbolLog>());
      events.push_back(logs.back().get());
    }
    simulation = std::make_unique<BusSimulation>(cluster, std::move(nodes), std::move(events));
  }
  void run_cycles(int cycles) { simulation->run_until(simulation->now() + cluster.cycle() * cycles); }
  bool all_active(std::size_t from = 0) const {
    for (std::size_t n = from; n < cluster.nodes.size(); ++n)
      if (simulation->controller(static_cast<NodeId>(n)).state().kind != PocKind::kNormalActive) return false;
    return true;
  }
  bool ever_active() const {
    return std::ranges::any_of(logs, [](const auto& log) {
      return std::ranges::any_of(log->states.changes,
                                 [](const StateLog::Change& change) { return change.to == PocKind::kNormalActive; });
    });
  }
};

TEST(RefusedDemo, AsShippedItStartsUp) {
  for (std::uint32_t index = 0; index < kDraws; ++index) {
    Driven driven(demo("", ""), index);
    driven.run_cycles(40);
    EXPECT_TRUE(driven.all_active()) << index;
  }
}

// Drives it for 200 cycles, after which all attempts at a cold start are over. Never are all nodes active. Returns in how
// many drives some node was.
int drives_with_an_active_node(const schedules::model::Cluster& cluster) {
  int drives = 0;
  for (std::uint32_t index = 0; index < kDraws; ++index) {
    Driven driven(cluster, index);
    driven.run_cycles(200);
    EXPECT_FALSE(driven.all_active()) << index;
    EXPECT_TRUE(std::ranges::any_of(driven.logs, [](const auto& log) { return !log->symbols.empty(); })) << index;
    drives += driven.ever_active();
  }
  return drives;
}

// Startup frames count only if they come in the very microtick.
TEST(RefusedDemo, WithoutAnAcceptedStartupRangeNoColdStartSucceeds) {
  const schedules::model::Cluster cluster = demo("pdAcceptedStartupRange", "0");
  EXPECT_TRUE(is_refused(cluster, "pdAcceptedStartupRange"));
  EXPECT_EQ(drives_with_an_active_node(cluster), 1);
}

TEST(RefusedDemo, WithCompensationsOfFiveMicrosecondsNoColdStartSucceeds) {
  schedules::model::Cluster cluster = demo("pDelayCompensationA", "200");
  EXPECT_TRUE(is_refused(cluster, "pDelayCompensationA"));
  for (schedules::model::Node& node : cluster.nodes) node.flexray->pDelayCompensationB = 200;
  EXPECT_EQ(drives_with_an_active_node(cluster), 0);
}

// Node 0 comes back in the network idle time of a running cluster, while the bus is silent. 1,284 microticks are 32.1 us.
// With the right timeout it receives the cluster instead.
TEST(RefusedDemo, AfterAShortListenTimeoutACasGoesIntoTheRunningCluster) {
  const schedules::model::Cluster hasty = demo("pdListenTimeout", "1284"), shipped = demo("", "");
  EXPECT_TRUE(is_refused(hasty, "pdListenTimeout"));
  for (std::uint32_t index = 0; index < kDraws; ++index)
    for (const int timeout : {1284, shipped.nodes[0].flexray->pdListenTimeout}) {
      schedules::model::Cluster cluster = shipped;  // so that it starts
      cluster.nodes[0].flexray->pdListenTimeout = timeout;
      Driven driven(cluster, index);
      driven.run_cycles(40);
      ASSERT_TRUE(driven.all_active()) << index;
      driven.simulation->power_off(NodeId{0});
      driven.run_cycles(5);
      ASSERT_TRUE(driven.all_active(1)) << index;
      driven.logs[0]->symbols.clear();
      driven.logs[0]->states.changes.clear();
      const timebase::CycleClock& clock = *driven.simulation->controller(NodeId{1}).clock();
      TrueTime idle = driven.simulation->oscillator(NodeId{1}).time_of(clock.start_of(Macroticks{1600}));
      if (idle <= driven.simulation->now()) idle = idle + cluster.cycle();
      driven.simulation->power_on(NodeId{0}, idle);
      driven.simulation->run_until(idle + Duration::microseconds(50));
      EXPECT_TRUE(driven.all_active(1)) << index;
      const std::vector<Microticks>& symbols = driven.logs[0]->symbols;
      ASSERT_EQ(symbols.size(), timeout == 1284 ? 2u : 0u) << index;  // on both channels
      for (const Microticks symbol : symbols)
        EXPECT_EQ((symbol - driven.logs[0]->states.changes.front().at).value, 1284) << index;
      if (timeout == 1284) continue;
      driven.run_cycles(20);
      EXPECT_TRUE(driven.all_active()) << index;
      EXPECT_TRUE(symbols.empty()) << index;
    }
}

}  // namespace
}  // namespace ttf::sim::engine
