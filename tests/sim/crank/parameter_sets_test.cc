// Drawn sets of FlexRay parameters. A set that passes the check starts up, takes a restarted node back, and keeps its
// assumed precision. Other sets break one constraint; some of them do so nevertheless, and are counted
// (docs/flexray_constraints.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/check/constraints.h"
#include "schedules/model/wire_times.h"
#include "sim/crank/bus_simulation.h"
#include "tests/sim/crank/bus_clusters.h"

namespace ttf::sim::crank {
namespace {

using bus::poc::PocKind;
using schedules::check::Constrained;
using schedules::check::Constraint;
using schedules::model::GlobalParameters;
using schedules::model::NodeParameters;

constexpr int kStartCycles = 40, kRestartCycles = 30;

std::int64_t up(double value) { return static_cast<std::int64_t>(std::ceil(value)); }

// A constraint that a set breaks, how, if there are two ways, and where.
struct Broken {
  std::string constraint, how, where;
};

// Draws clusters of status frames within the specification's ranges. Each parameter with a constraint has its bound, and
// some room.
class Drawn {
 public:
  explicit Drawn(std::uint32_t index) : draw_({1, index, Purpose::kTest, 77, 0}) {}

  schedules::model::Cluster cluster() {
    schedules::model::Cluster made;
    made.name = "drawn";
    GlobalParameters& g = made.flexray;
    bits(g);
    const int nodes = number(2, 5);
    g.gClusterDriftDamping = number(0, 4);
    g.gdMaxPropagationDelay_ps = 100'000 * number(1, 25);
    g.gdMinPropagationDelay_ps = g.gdMaxPropagationDelay_ps / 4 * number(0, 2);
    g.gdTSSTransmitter = number(3, 15);
    g.gPayloadLengthStatic = number(0, 20);
    const double precision = static_cast<double>(schedules::model::assumed_precision_ps(g));
    const double macrotick = static_cast<double>(g.gdMacrotick_ps), slow = 0.9985;
    g.gdActionPointOffset = static_cast<int>(std::max<std::int64_t>(
                                up((precision - static_cast<double>(g.gdMinPropagationDelay_ps)) / macrotick), 1)) +
                            number(0, 2);
    g.gdStaticSlot = static_cast<int>(schedules::check::shortest_static_slot(g)) + number(0, 3);
    g.gNumberOfStaticSlots = nodes + number(0, 6);
    const std::int64_t per_macrotick = g.gdMacrotick_ps / microtick_ps_;
    const std::int64_t least = up(precision / static_cast<double>(microtick_ps_));
    const int room =
        static_cast<int>(up(static_cast<double>(least + 2) / (slow * static_cast<double>(per_macrotick) - 2)));
    const int correction = room + number(1, 40);
    g.gdNIT = std::max(correction + number(1, 40), 2);
    g.gMacroPerCycle = g.gdStaticSlot * g.gNumberOfStaticSlots + g.gdNIT;
    g.gdCycle_ps = g.cycle_ps();
    g.gOffsetCorrectionStart = g.gMacroPerCycle - correction;
    g.gSyncNodeMax = std::max(nodes, 2);
    g.gdCASRxLowMax =
        std::max<int>(67, static_cast<int>(up(2 * (g.gdTSSTransmitter + 30) * 1.0015 / slow))) + number(0, 8);
    const std::int64_t worst_ppm = number(0, 1500);
    for (int n = 0; n < nodes; ++n) {
      schedules::model::Node node;
      node.name = "node" + std::to_string(n);
      node.max_drift_ppb = worst_ppm * 1000;
      node.microtick_ps = microtick_ps_;
      node.flexray.emplace();
      parameters(g, precision, worst_ppm, *node.flexray);
      node.flexray->pKeySlotId = n + 1;
      node.flexray->pKeySlotUsedForSync = n < 2 || draw_.uniform() < 0.8;
      node.flexray->pKeySlotUsedForStartup = node.flexray->pKeySlotUsedForSync && (n < 3 || draw_.uniform() < 0.5);
      if (n == 2) node.flexray->pKeySlotUsedForSync = node.flexray->pKeySlotUsedForStartup = true;
      made.nodes.push_back(std::move(node));
      made.frames.push_back({n + 1, schedules::model::Channels::kAB, 0, 1, static_cast<NodeId>(n), kNoPdu, 0, 0});
    }
    return made;
  }
  // Breaks one constraint, in one node or in all, if there is room within the parameter's range.
  std::optional<Broken> broken(schedules::model::Cluster& cluster) {
    NodeParameters& p =
        *cluster.nodes[static_cast<std::size_t>(number(0, static_cast<int>(cluster.nodes.size()) - 1))].flexray;
    const NodeParameters before = p;
    std::optional<Broken> done = broken(cluster.flexray, p);
    const bool in_all = draw_.uniform() < 0.5;
    for (int NodeParameters::*const member :
         {&NodeParameters::pdListenTimeout, &NodeParameters::pdAcceptedStartupRange,
          &NodeParameters::pDelayCompensationA, &NodeParameters::pDelayCompensationB,
          &NodeParameters::pOffsetCorrectionOut, &NodeParameters::pRateCorrectionOut}) {
      if (!done || p.*member == before.*member) continue;
      done->where = in_all ? ", in all nodes" : ", in one node";
      for (auto& node : cluster.nodes)
        if (in_all) node.flexray.value().*member = p.*member;
    }
    return done;
  }

 private:
  std::optional<Broken> broken(GlobalParameters& g, NodeParameters& p) {
    const auto within = [&](int& parameter, std::int64_t low, std::int64_t high) {
      if (low > high) return false;
      parameter = static_cast<int>(draw_.integer(low, high));
      return true;
    };
    const std::int64_t precision = schedules::model::assumed_precision_ps(g);
    const std::int64_t most_delay = (g.gdMaxPropagationDelay_ps + microtick_ps_ - 1) / microtick_ps_;
    switch (number(0, 8)) {
      case 0: {  // evenly in the logarithm: the shortest do most harm
        const double ratio = std::pow(1284.0 / p.pdListenTimeout, draw_.uniform());
        p.pdListenTimeout = static_cast<int>(std::min(p.pdListenTimeout * ratio, p.pdListenTimeout - 1.0));
        return Broken{"listen_timeout", ", too short", ""};
      }
      case 1: return named("listen_timeout", within(p.pdListenTimeout, p.pdListenTimeout + 1, 1'283'846), ", too long");
      case 2:
        return named("accepted_startup_range", within(p.pdAcceptedStartupRange, 0, precision / microtick_ps_ - 1));
      case 3: return named("delay_compensation_a", within(p.pDelayCompensationA, most_delay + 1, 200));
      case 4: return named("delay_compensation_b", within(p.pDelayCompensationB, most_delay + 1, 200));
      case 5: return named("cas_length", within(g.gdCASRxLowMax, 67, 2 * (g.gdTSSTransmitter + 30)));
      case 6:
        return named("action_point",
                     within(g.gdActionPointOffset, 1, (precision - g.gdMinPropagationDelay_ps - 1) / g.gdMacrotick_ps));
      case 7: return named("offset_correction", within(p.pOffsetCorrectionOut, 5, precision / microtick_ps_ - 1));
      case 8: {
        if (!within(p.pRateCorrectionOut, 2, least_rate_ - 1)) return std::nullopt;
        p.pdListenTimeout = 2 * (p.pMicroPerCycle + p.pRateCorrectionOut);
        return Broken{"rate_correction", "", ""};
      }
      default: return std::nullopt;
    }
  }
  static std::optional<Broken> named(const char* name, bool possible, const char* how = "") {
    return possible ? std::optional<Broken>({name, how, ""}) : std::nullopt;
  }
  int number(std::int64_t low, std::int64_t high) { return static_cast<int>(draw_.integer(low, high)); }
  void bits(GlobalParameters& g) {
    g.gdBit_ps = 100'000 << number(0, 2);
    g.baudrate = 1'000'000'000'000 / g.gdBit_ps;
    do {
      samples_ = 1 << number(0, 2);
      microtick_ps_ = samples_ * g.gdBit_ps / 8;
    } while (microtick_ps_ > 50'000);
    g.gdMaxMicrotick_ps = microtick_ps_;
    g.gdMacrotick_ps = 1'000'000 * number(std::max<std::int64_t>(1, 40 * microtick_ps_ / 1'000'000), 6);
    g.gdWakeupSymbolTxLow = static_cast<int>(6'000'000 / g.gdBit_ps);
    g.gdWakeupSymbolTxIdle = static_cast<int>(18'000'000 / g.gdBit_ps);
    g.gdWakeupSymbolRxLow = g.gdWakeupSymbolTxLow - 4;
    g.gdWakeupSymbolRxIdle = (g.gdWakeupSymbolTxIdle - g.gdWakeupSymbolTxLow) / 2 - 1;
    g.gdWakeupSymbolRxWindow = 2 * g.gdWakeupSymbolTxLow + g.gdWakeupSymbolTxIdle + 1;
  }
  void parameters(const GlobalParameters& g, double precision, std::int64_t worst_ppm, NodeParameters& p) {
    p.pdMicrotick_ps = microtick_ps_;
    p.pSamplesPerMicrotick = samples_;
    p.pMicroPerCycle = static_cast<int>(g.gdCycle_ps / microtick_ps_);
    const double drift = static_cast<double>(worst_ppm) * 1e-6;
    least_rate_ = std::max<std::int64_t>(2, up(p.pMicroPerCycle * 2 * drift / (1 - drift)));
    p.pRateCorrectionOut = static_cast<int>(least_rate_) + number(0, 10);
    const std::int64_t least = up(precision / static_cast<double>(microtick_ps_));
    const std::int64_t macroticks = g.gMacroPerCycle - g.gOffsetCorrectionStart;
    const std::int64_t most = macroticks * (p.pMicroPerCycle - p.pRateCorrectionOut) / g.gMacroPerCycle - macroticks;
    p.pOffsetCorrectionOut = number(least, std::max(least, most));
    p.pClusterDriftDamping = number(0, g.gClusterDriftDamping);
    p.pDelayCompensationA = delay(g);
    p.pDelayCompensationB = delay(g);
    const std::int64_t range = up(precision / (static_cast<double>(microtick_ps_) * 0.9985));
    p.pdAcceptedStartupRange = number(range, 2 * range);
    p.pdListenTimeout = 2 * (p.pMicroPerCycle + p.pRateCorrectionOut);
    p.pAllowPassiveToActive = 2;
    p.pAllowHaltDueToClock = true;
  }
  int delay(const GlobalParameters& g) {
    return number(g.gdMinPropagationDelay_ps / microtick_ps_,
                  (g.gdMaxPropagationDelay_ps + microtick_ps_ - 1) / microtick_ps_);
  }

  RandomStream draw_;
  std::int64_t microtick_ps_ = 25'000, least_rate_ = 0;
  int samples_ = 2;
};

// The names of the constraints that do not hold.
std::vector<std::string> violated(const schedules::model::Cluster& cluster) {
  std::vector<std::string> names;
  std::int64_t worst = 0;
  for (const auto& node : cluster.nodes) worst = std::max(worst, schedules::analysis::worst_drift_ppb(node));
  const auto add = [&](Constraint::On on, const Constrained& subject) {
    for (const Constraint& one : schedules::check::constraints())
      if (one.on == on && !one.holds(subject) && std::ranges::find(names, one.name) == names.end())
        names.emplace_back(one.name);
  };
  add(Constraint::On::kCluster, {cluster, NodeParameters{}});
  for (const auto& node : cluster.nodes)
    add(Constraint::On::kController, {cluster, *node.flexray, schedules::analysis::worst_drift_ppb(node), worst});
  return names;
}

// The behaviour of a cluster in a drive. Its clocks are drawn, and its supplies come within two cycles.
struct Shown {
  bool starts = false;      // all are active in 40 cycles
  bool takes_back = false;  // a coldstart node restarts and comes back, and disturbs no other
  bool precise = false;     // all along

  bool all() const { return starts && takes_back && precise; }
};

Shown drive(const schedules::model::Cluster& cluster, std::uint32_t index) {
  RandomStream draw({2, index, Purpose::kTest, 78, 0});
  std::vector<std::unique_ptr<StateLog>> logs;
  std::vector<BusNode> nodes;
  std::vector<bus::controller::ControllerEvents*> events;
  const Duration cycle = cluster.cycle();
  for (const auto& node : cluster.nodes) {
    const std::int64_t microtick = node.flexray->pdMicrotick_ps;
    const std::int64_t most = schedules::analysis::worst_drift_ppb(node);
    nodes.push_back({timebase::Oscillator{microtick, draw.integer(-most, most), draw.integer(0, microtick - 1)},
                     TrueTime{draw.integer(0, 2 * cycle.ns)}});
    logs.push_back(std::make_unique<StateLog>());
    events.push_back(logs.back().get());
  }
  BusSimulation simulation(cluster, std::move(nodes), std::move(events));
  const auto active = [&](std::size_t n) {
    return simulation.controller(static_cast<NodeId>(n)).state().kind == PocKind::kNormalActive;
  };
  const auto all_active = [&](std::size_t from) {
    for (std::size_t n = from; n < cluster.nodes.size(); ++n)
      if (!active(n)) return false;
    return true;
  };
  Shown shown{.precise = true};
  const Duration allowed = schedules::model::assumed_precision(cluster.flexray);
  const auto run_cycles = [&](int cycles, auto wanted) {
    for (int half = 0; half < 2 * cycles; ++half) {
      simulation.run_until(simulation.now() + Duration{cycle.ns / 2});
      if (simulation.precision() > allowed) shown.precise = false;
      if (wanted()) return true;
    }
    return false;
  };
  shown.starts = run_cycles(kStartCycles, [&] { return all_active(0); });
  if (!shown.starts) return shown;
  run_cycles(10, [] { return false; });
  simulation.power_off(NodeId{0});
  simulation.power_on(NodeId{0}, simulation.now() + Duration{draw.integer(0, cycle.ns)});
  bool others_stay = true;
  const bool back = run_cycles(kRestartCycles, [&] {
    others_stay = others_stay && all_active(1);
    return active(0) || !others_stay;
  });
  shown.takes_back = back && others_stay && active(0);
  run_cycles(4, [] { return false; });
  shown.takes_back = shown.takes_back && all_active(0);
  return shown;
}

struct Tally {
  int drawn = 0, starts = 0, takes_back = 0, precise = 0, all = 0;
  void add(const Shown& shown) {
    ++drawn;
    starts += shown.starts;
    takes_back += shown.takes_back;
    precise += shown.precise;
    all += shown.all();
  }
};

// Half of the sets pass, half of them break one constraint.
std::map<std::string, Tally> tally_of(std::uint32_t first, std::uint32_t sets) {
  std::map<std::string, Tally> tallies;
  for (std::uint32_t index = first; index < first + sets; ++index) {
    Drawn drawn(index);
    schedules::model::Cluster cluster = drawn.cluster();
    const std::vector<std::string> before = violated(cluster);
    EXPECT_TRUE(before.empty()) << "set " << index << " breaks " << before.front();
    std::string name;
    if (index % 2 == 1) {
      const auto broken = drawn.broken(cluster);
      if (!broken) continue;
      name = broken->constraint + broken->how + broken->where;
      EXPECT_EQ(violated(cluster), std::vector<std::string>{broken->constraint}) << "set " << index;
    }
    const Shown shown = drive(cluster, index);
    tallies[name].add(shown);
    if (name.empty()) {
      EXPECT_TRUE(shown.all()) << "set " << index << (shown.starts ? "" : " does not start")
                               << (shown.takes_back ? "" : " does not take a node back")
                               << (shown.precise ? "" : " is not precise");
    }
  }
  return tallies;
}

TEST(ParameterSets, ThatPassStartUpAndKeepTheirPrecision) {
  const auto tallies = tally_of(0, 400);
  EXPECT_EQ(tallies.at("").drawn, 200);
}

// Prints the numbers of docs/flexray_constraints.md.
TEST(ParameterSets, TenThousandThatPassStartUp) {
  const auto tallies = tally_of(0, 20'000);
  EXPECT_EQ(tallies.at("").drawn, 10'000);
  for (const auto& [name, tally] : tallies)
    std::printf("%-40s %6d drawn %6d start %6d take back %6d precise %6d all\n",
                name.empty() ? "(passes)" : name.c_str(), tally.drawn, tally.starts, tally.takes_back, tally.precise,
                tally.all);
}

}  // namespace
}  // namespace ttf::sim::crank
