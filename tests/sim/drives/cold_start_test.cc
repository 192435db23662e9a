// Drives that begin with nodes powered on one after the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "evaluation/cluster/startup_account.h"
#include "sim/drives/step_catalog.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;

constexpr char kScenario[] = "scenarios/cold_start.yaml";

NodeId named(const schedules::model::Cluster& cluster, std::string_view name) {
  return cluster.find_node(name).value();
}

struct Reported final : recording::records::Sink {
  struct Symbol {
    TrueTime start, end;
    NodeId node;
    int channel;
    recording::records::Symbol kind;
  };
  std::map<NodeId, std::vector<TrueTime>> powered;
  std::vector<Symbol> symbols;
  std::vector<recording::records::ReferenceFix> fixes;
  std::map<MeasurementId, TrueTime> measured;
  std::vector<std::pair<MeasurementId, TrueTime>> fused;  // the list's stamp of its measurement
  std::map<std::uint32_t, TrueTime> images;               // the image's instant
  Duration image_off{};                                   // most that the feature service takes it to be of another one

  using recording::records::Sink::on;
  void on(const recording::records::PowerChanged& r) override {
    if (r.on) powered[r.stamp.node].push_back(r.stamp.true_time);
  }
  void on(const recording::records::SymbolSent& r) override {
    symbols.push_back({r.stamp.true_time, r.end.true_time, r.stamp.node, r.channel, r.kind});
  }
  void on(const recording::records::ReferenceFix& r) override { fixes.push_back(r); }
  void on(const recording::records::Measured& r) override { measured[r.id] = r.stamp.true_time; }
  void on(const recording::records::FusionInput& r) override {
    fused.emplace_back(MeasurementId{r.sensor, r.sequence}, recording::records::true_time_of(r.stamp, r.measured));
  }
  void on(const recording::records::ImageWritten& r) override {
    images[r.sequence] = recording::records::true_time_of(r.stamp, r.valid_at);
  }
  void on(const recording::records::FeatureUsed& r) override {
    const auto image = images.find(r.image_sequence);
    if (image == images.end()) return;
    const Duration off = recording::records::true_time_of(r.stamp, r.image_valid_at) - image->second;
    image_off = std::max({image_off, off, -off});
  }
};

TEST(ColdStart, OneLeadsFromCycle6OthersFollowIn7AndIntegrateIn8) {
  const Drive drive(kScenario, StrategyKind::kTt);
  evaluation::cluster::StartupAccount account(drive.cluster.cycle());
  drive.run(account);
  ASSERT_EQ(account.nodes().size(), 6u);
  for (const evaluation::cluster::NodeStartup& node : account.nodes()) {
    const std::string& name = drive.cluster.node(node.node).name;
    ASSERT_TRUE(node.active.has_value()) << name;
    EXPECT_EQ(node.active->cycle, name == "fusion" ? 6 : name == "laser" || name == "camera" ? 8 : 7) << name;
    EXPECT_EQ(node.active->from, name == "fusion"                      ? "coldstart consistency check"
                                 : name == "laser" || name == "camera" ? "integration consistency check"
                                                                       : "coldstart join")
        << name;
    EXPECT_EQ(node.state, "normal active") << name;
  }
}

// In any order of power-on, every node is active within two listen timeouts, the spread, and an attempt's or
// two's cycles.
TEST(ColdStart, EveryNodeBecomesActiveWhateverThePowerOnTimes) {
  Drive drive(kScenario, StrategyKind::kAdva);
  drive.scenario.startup.power_on.clear();
  drive.scenario.duration = drive.scenario.world.duration = Duration::milliseconds(200);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    evaluation::cluster::StartupAccount account(drive.cluster.cycle());
    drive.run(account, seed);
    for (const evaluation::cluster::NodeStartup& node : account.nodes())
      EXPECT_TRUE(node.active.has_value()) << "seed " << seed << ": " << drive.cluster.node(node.node).name << " is in "
                                           << node.state << ": " << node.why;
  }
}

// The tracker warms up for 1.5 s, start-up takes some 60 ms. So a cold drive matches an integrated one, up to
// one drive's noise, which differs as measurements are some milliseconds later. Pooled over ten drives of
// either kind, errors agree within a quarter.
TEST(ColdStart, IsWorthWhatAnIntegratedDriveIs) {
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    Drive drive("scenarios/paper_scenario2.yaml", strategy);
    double squares[2] = {}, velocities[2] = {}, ages[2] = {};
    std::uint64_t matched[2] = {}, missed[2] = {};
    for (const bool cold : {false, true})
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        drive.scenario.startup.cold = cold;
        evaluation::accuracy::DriveMeasures measures(evaluation_start(drive.scenario));
        drive.run(measures, seed);
        const evaluation::accuracy::DriveSummary summary = measures.finish();
        const auto n = static_cast<double>(summary.matched);
        squares[cold] += n * summary.position_rmse_truth * summary.position_rmse_truth;
        velocities[cold] += n * summary.velocity_rmse_truth * summary.velocity_rmse_truth;
        ages[cold] += n * summary.age_used.mean().seconds();
        matched[cold] += summary.matched;
        missed[cold] += summary.missed;
      }
    const auto pooled = [&](const double(&sums)[2], bool cold) {
      return std::sqrt(sums[cold] / static_cast<double>(matched[cold]));
    };
    SCOPED_TRACE(name_of(strategy));
    EXPECT_NEAR(pooled(squares, true) / pooled(squares, false), 1.0, 0.25);
    EXPECT_NEAR(pooled(velocities, true) / pooled(velocities, false), 1.0, 0.25);
    EXPECT_NEAR(static_cast<double>(matched[1]), static_cast<double>(matched[0]),
                0.05 * static_cast<double>(matched[0]));
    EXPECT_NEAR(ages[1] / static_cast<double>(matched[1]), ages[0] / static_cast<double>(matched[0]), 0.005) << "5 ms";
    EXPECT_LE(missed[1], missed[0] + 10);
  }
}

// A list's stamp is its strobe's on the host's clock, to the microsecond; the precision and a macrotick add
// to that. The reader's clock converts global times to true ones. Its rate is off by less than 1500 ppm over
// less than 130 ms.
constexpr Duration kStampsAgree = Duration::microseconds(200);

void expect_stamps_mean_what_was_measured(const Reported& reported, std::size_t at_least) {
  std::size_t compared = 0;
  for (const auto& [id, said] : reported.fused) {
    const auto truly = reported.measured.find(id);
    ASSERT_NE(truly, reported.measured.end());
    const Duration off = said - truly->second;
    EXPECT_LE(std::max(off, -off), kStampsAgree) << "sensor " << index_of(id.sensor) << " #" << id.sequence;
    ++compared;
  }
  EXPECT_GE(compared, at_least);
  EXPECT_LE(reported.image_off, kStampsAgree);
  EXPECT_GT(reported.images.size(), 20u);
}

TEST(ColdStart, ListsSayWhenTheyWereMeasured) {
  Reported reported;
  Drive(kScenario, StrategyKind::kAdva).run(reported);
  expect_stamps_mean_what_was_measured(reported, 80);
}

// GPS time is converted to the cluster's time scale: a fix has the fusion node's clock reading.
TEST(ColdStart, FixesAreOnTheClustersTimeScale) {
  Reported reported;
  struct Scale final : recording::records::Sink {
    std::vector<std::pair<TrueTime, GlobalTime>> readings;
    using recording::records::Sink::on;
    void on(const recording::records::FusionStep& r) override {
      readings.emplace_back(r.stamp.true_time, r.stamp.global);
    }
  } scale;
  recording::records::Tee tee({&reported, &scale});
  Drive(kScenario, StrategyKind::kTt).run(tee);
  ASSERT_GT(reported.fixes.size(), 5u);
  ASSERT_GT(scale.readings.size(), 100u);
  EXPECT_GT((scale.readings.front().first - TrueTime{}) - (scale.readings.front().second - GlobalTime{}),
            Duration::milliseconds(4))
      << "cycle 0 comes milliseconds later than in an integrated drive";
  for (const recording::records::ReferenceFix& fix : reported.fixes) {
    const auto after = std::lower_bound(scale.readings.begin(), scale.readings.end(), fix.measured_true,
                                        [](const auto& reading, TrueTime at) { return reading.first < at; });
    if (after == scale.readings.end()) continue;
    const Duration off = (fix.measured - after->second) - (fix.measured_true - after->first);
    EXPECT_LE(std::max(off, -off), kStampsAgree);
  }
}

// Fusion wakes the others, on channel A. They are powered on a millisecond after the end of the pattern, the
// camera's host two.
TEST(ColdStart, AWakeupPatternPowersTheOthersOn) {
  Drive drive(kScenario, StrategyKind::kTt);
  drive.scenario.startup.wake_up = "fusion";
  drive.scenario.startup.spread = Duration{};
  drive.scenario.startup.power_on = {{"fusion", Duration::milliseconds(1), 0}};
  for (const char* name : {"laser_pre", "feature", "laser", "camera"})
    drive.scenario.startup.power_on.push_back({name, Duration::milliseconds(1), 0});
  drive.scenario.startup.power_on.push_back({"camera_pre", Duration::milliseconds(2), 0});
  Reported reported;
  evaluation::cluster::StartupAccount account(drive.cluster.cycle());
  recording::records::Tee tee({&reported, &account});
  drive.run(tee);
  ASSERT_FALSE(reported.symbols.empty());
  const Reported::Symbol& pattern = reported.symbols.front();
  EXPECT_EQ(pattern.kind, recording::records::Symbol::kWakeup);
  EXPECT_EQ(pattern.node, named(drive.cluster, "fusion"));
  EXPECT_EQ(pattern.channel, 0);
  EXPECT_EQ(std::count_if(reported.symbols.begin(), reported.symbols.end(),
                          [](const Reported::Symbol& s) { return s.kind == recording::records::Symbol::kWakeup; }),
            1);
  EXPECT_EQ(reported.powered.size(), 6u);
  for (const auto& [node, times] : reported.powered) {
    ASSERT_EQ(times.size(), 1u);
    const std::string& name = drive.cluster.node(node).name;
    if (name == "fusion") {
      EXPECT_LT(times[0], pattern.start);
      continue;
    }
    // The longest propagation delay and the oscillators' drifts come on top.
    const Duration boots = Duration::milliseconds(name == "camera_pre" ? 2 : 1);
    EXPECT_NEAR(static_cast<double>((times[0] - pattern.end).ns), static_cast<double>(boots.ns), 4'000) << name;
  }
  for (const evaluation::cluster::NodeStartup& node : account.nodes())
    EXPECT_TRUE(node.active.has_value()) << drive.cluster.node(node.node).name;
}

// Two lose their supply before wake-up. One gets it back after all wake-ups: it starts up at once.
TEST(ColdStart, ASleepersSupplyIsNotReportedBeforeItIsAwake) {
  struct Supplies final : recording::records::Sink {
    using recording::records::Sink::on;
    std::map<NodeId, std::vector<bool>> reported;
    void on(const recording::records::PowerChanged& r) override { reported[r.stamp.node].push_back(r.on); }
  };
  Drive drive(kScenario, StrategyKind::kTt);
  drive.scenario.duration = drive.scenario.world.duration = Duration::milliseconds(300);
  drive.scenario.startup.wake_up = "fusion";
  for (const char* name : {"feature", "camera"}) {
    ttf::faults::Fault& crash = drive.scenario.faults.faults.emplace_back();
    crash.kind = ttf::faults::FaultKind::kCrash;
    crash.node_name = name;
    crash.from = Duration::milliseconds(1);
  }
  drive.scenario.faults.faults.back().duration = Duration::milliseconds(200);
  Supplies supplies;
  drive.run(supplies);
  EXPECT_EQ(supplies.reported.size(), 5u) << "all but the one that never had any";
  EXPECT_EQ(supplies.reported.count(named(drive.cluster, "feature")), 0u);
  for (const auto& [node, reported] : supplies.reported)
    EXPECT_EQ(reported, std::vector{true}) << drive.cluster.node(node).name;
}

TEST(ColdStart, WithARecordingItIsRefused) {
  Drive drive("scenarios/laser_radar_recorded.yaml", StrategyKind::kTt);
  drive.scenario.startup.cold = true;
  EXPECT_THROW(check_recording(drive.scenario, drive.cluster, true), InputError);
  drive.scenario.startup.cold = false;
  EXPECT_NO_THROW(check_recording(drive.scenario, drive.cluster, true));
}

// ---- a node loses its supply in the middle of a drive, and comes back

struct Restarted {
  Reported reported;
  std::map<NodeId, GlobalTime> global;  // at the end, by each node's clock
};

Restarted restarted(std::string_view name) {
  const Drive drive(kScenario, StrategyKind::kAdva);
  const TrueTime start = drive_start(drive.cluster);
  const auto scene = std::make_shared<sensors::WorldScene>(drive.scenario.world, 1, 0, start);
  const NodeSetConfig set{&drive.scenario, &drive.cluster, drive.strategy, 1, 0, scene, nullptr};
  const auto starts = node_starts(drive.scenario.startup, drive.cluster, 1, 0);
  sim::engine::SimulationConfig config;
  config.cluster = &drive.cluster;
  config.seed = 1;
  config.make_steps = [&](NodeId node) { return make_steps(set, node); };
  config.power_on = [&](NodeId node) { return std::optional(start + starts[index_of(node)].after); };
  Restarted result;
  sim::engine::ClusterSimulation simulation(config, result.reported);
  simulation.run_until(start + Duration::milliseconds(1'000));
  const NodeId node = named(drive.cluster, name);
  simulation.power_off(node);
  simulation.power_on(node, start + Duration::milliseconds(1'005));
  simulation.run_until(start + Duration::milliseconds(2'500));
  for (std::size_t n = 0; n < drive.cluster.nodes.size(); ++n) {
    const nodes::host::Executive& executive = simulation.node(static_cast<NodeId>(n));
    EXPECT_NE(executive.clock(), nullptr) << drive.cluster.nodes[n].name;
    result.global[static_cast<NodeId>(n)] = executive.stamp(executive.oscillator().ticks_at(simulation.now())).global;
  }
  return result;
}

// Cycles of 2 ms: a round is 128 ms. After more than a second the restarted node counts whole rounds less.
// All nodes still understand the instants of measurement.
TEST(ColdStart, ARestartedNodesStampsAreUnderstoodModuloARound) {
  for (const char* name : {"laser_pre", "camera_pre", "fusion", "feature"}) {
    SCOPED_TRACE(name);
    const Restarted drive = restarted(name);
    const schedules::model::Cluster cluster = Drive(kScenario, StrategyKind::kAdva).cluster;
    const NodeId node = named(cluster, name),
                 other = named(cluster, std::string_view(name) == "fusion" ? "feature" : "fusion");
    const Duration behind = drive.global.at(other) - drive.global.at(node);
    const std::int64_t rounds = (behind.ns + cluster.round().ns / 2) / cluster.round().ns;
    EXPECT_GE(rounds, 7);
    EXPECT_LE(std::abs(behind.ns - rounds * cluster.round().ns), 10'000) << "apart by whole rounds and the precision";
    expect_stamps_mean_what_was_measured(drive.reported, 60);
  }
}

}  // namespace
}  // namespace ttf::sim::drives
