// Drawn sets of FlexRay parameters. A set that passes the check starts up, takes a restarted node back, keeps its
// assumed precision, and loses no frame. Other sets break one constraint; some of them do so nevertheless, and are counted
// (docs/schedules/flexray_constraints.md).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/file_bytes.h"
#include "core/random.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/model/wire_times.h"
#include "sim/engine/bus_simulation.h"
#include "tests/bus/layouts.h"
#include "tests/sim/engine/bus_clusters.h"
#include "tests/sim/engine/drawn_parameters.h"

namespace ttf::sim::engine {
namespace {

using bus::poc::PocKind;

constexpr int kStartCycles = 40, kRestartCycles = 30;

// The behaviour of a cluster in a drive. Its clocks are drawn, and its supplies come within two cycles.
struct Shown {
  bool starts = false;      // all are active in 40 cycles
  bool takes_back = false;  // a coldstart node restarts and comes back, and disturbs no other
  bool precise = false;     // all along
  bool frames = false;      // calm cycles without a slot problem, in which all dynamic frames arrive
  int last_counter = 0;     // the largest value of the cycle counter in them, in the frames that came

  bool all() const { return starts && takes_back && precise && frames; }
};

// Counts a controller's slot problems, and the lists that reach it.
struct FrameLog final : bus::controller::ControllerEvents {
  int problems = 0, lists = 0, last_counter = 0;
  bool wants_bytes() const override { return false; }
  void slot_problem(std::int64_t, int, schedules::model::Channel, bus::controller::SlotStatus, Microticks) override {
    ++problems;
  }
  void frame_received(std::int64_t, int, schedules::model::Channel, const bus::wire::DecodedFrame& frame,
                      Microticks) override {
    last_counter = std::max<int>(last_counter, frame.header.cycle);
  }
  void list_arrived(PduId, bus::cni::ArrivalEffect effect, std::uint32_t, std::optional<std::uint32_t>,
                    Microticks) override {
    lists += effect == bus::cni::ArrivalEffect::kCompleted;
  }
};

Shown drive(const schedules::model::Cluster& cluster, std::uint32_t index, int calm_cycles = 10) {
  RandomStream draw({2, index, Purpose::kTest, 78, 0});
  std::vector<std::unique_ptr<FrameLog>> logs;
  std::vector<BusNode> nodes;
  std::vector<bus::controller::ControllerEvents*> events;
  const Duration cycle = cluster.cycle();
  for (const auto& node : cluster.nodes) {
    const std::int64_t microtick = node.flexray->pdMicrotick_ps;
    const std::int64_t most = schedules::analysis::worst_drift_ppb(node);
    nodes.push_back({timebase::Oscillator{microtick, draw.integer(-most, most), draw.integer(0, microtick - 1)},
                     TrueTime{draw.integer(0, 2 * cycle.ns)}});
    logs.push_back(std::make_unique<FrameLog>());
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
  std::uint32_t sequence = 0;
  bool lists_are_sent = false;
  const auto write_lists = [&] {
    if (!lists_are_sent) return;
    ++sequence;
    for (std::size_t n = 0; n < cluster.pdus.size(); ++n) {
      const bus::MadeList list(cluster.pdus[n], sequence, 3, 0);
      simulation.controller(static_cast<NodeId>(n)).outgoing(static_cast<PduId>(n)).write(list.view());
    }
  };
  const auto run_cycles = [&](int cycles, auto wanted) {
    for (int half = 0; half < 2 * cycles; ++half) {
      write_lists();
      simulation.run_until(simulation.now() + Duration{cycle.ns / 2});
      if (simulation.precision() > allowed) shown.precise = false;
      if (wanted()) return true;
    }
    return false;
  };
  shown.starts = run_cycles(kStartCycles, [&] { return all_active(0); });
  if (!shown.starts) return shown;
  lists_are_sent = true;
  run_cycles(2, [] { return false; });
  for (const auto& log : logs) *log = {};
  run_cycles(calm_cycles, [] { return false; });
  shown.frames = true;
  for (const auto& log : logs) {
    const std::size_t from_others = cluster.pdus.empty() ? 0 : cluster.nodes.size() - 1;
    shown.frames =
        shown.frames && log->problems == 0 && log->lists >= (calm_cycles - 1) * static_cast<int>(from_others);
    shown.last_counter = std::max(shown.last_counter, log->last_counter);
  }
  lists_are_sent = false;
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
  int drawn = 0, starts = 0, takes_back = 0, precise = 0, frames = 0, all = 0;
  void add(const Shown& shown) {
    ++drawn;
    starts += shown.starts;
    takes_back += shown.takes_back;
    precise += shown.precise;
    frames += shown.frames;
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
      const Broken broken = drawn.broken(cluster);
      name = broken.constraint + "`" + broken.how + broken.where;
      EXPECT_EQ(violated(cluster), std::vector<std::string>{broken.constraint}) << "set " << index;
    }
    const Shown shown = drive(cluster, index);
    tallies[name].add(shown);
    if (name.empty()) {
      EXPECT_TRUE(shown.all()) << "set " << index << (shown.starts ? "" : " does not start")
                               << (shown.takes_back ? "" : " does not take a node back")
                               << (shown.precise ? "" : " is not precise") << (shown.frames ? "" : " loses frames");
    }
  }
  return tallies;
}

TEST(ParameterSets, ThatPassStartUpAndKeepTheirPrecision) {
  const auto tallies = tally_of(0, 400);
  EXPECT_EQ(tallies.at("").drawn, 200);
}

// The protocol is the same whatever the last value of the cycle counter, as long as it is odd (FlexRay 3.0.1). The
// counter begins anew at least once before a node restarts.
TEST(ParameterSets, StartUpWithAnyRoundOfCycles) {
  for (std::uint32_t index = 0; index < 80; index += 2) {
    schedules::model::Cluster cluster = Drawn(index).cluster();
    cluster.flexray.gCycleCountMax = 7 + 2 * static_cast<int>(index % 29);
    const Shown shown = drive(cluster, index, cluster.flexray.gCycleCountMax + 10);
    EXPECT_TRUE(shown.all()) << "set " << index << " with gCycleCountMax " << cluster.flexray.gCycleCountMax;
    EXPECT_EQ(shown.last_counter, cluster.flexray.gCycleCountMax) << "set " << index;
  }
}

// A row of docs/schedules/flexray_constraints.md.
std::string row_of(const std::string& name, const Tally& tally) {
  return fmt::format("| `{} | {} | {} | {} | {} | {} | {} |", name, tally.drawn, tally.starts, tally.takes_back,
                     tally.precise, tally.frames, tally.all);
}

// The page has a row for each way to break a constraint. Rows that differ are printed.
TEST(ParameterSets, TenThousandThatPassStartUp) {
  const auto tallies = tally_of(0, 20'000);
  EXPECT_EQ(tallies.at("").drawn, 10'000);
  const std::string page = read_file(TTF_SOURCE_DIR "/docs/schedules/flexray_constraints.md");
  int refused = 0;
  for (const auto& [name, tally] : tallies) {
    if (name.empty()) continue;
    const std::string row = row_of(name, tally);
    EXPECT_NE(page.find("\n" + row + "\n"), std::string::npos) << row;
    refused += tally.drawn;
  }
  EXPECT_EQ(refused, 10'000);
}

}  // namespace
}  // namespace ttf::sim::engine
