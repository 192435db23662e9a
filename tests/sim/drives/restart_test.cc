// Whole clusters whose nodes come and go: crash and restart, cold start, one node after the other.
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "core/random.h"
#include "recording/log/writer.h"
#include "sim/engine/cluster_simulation.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;

Duration assumed_precision(const schedules::model::GlobalParameters& g) {
  return {((34 + 20 * g.gClusterDriftDamping) * g.gdMaxMicrotick_ps + 2 * g.gdMaxPropagationDelay_ps) / 1000};
}

struct Seen final : recording::records::Sink {
  using recording::records::Sink::on;
  std::vector<recording::records::PrecisionSample> precision;
  std::vector<TrueTime> images, uses;
  void on(const recording::records::PrecisionSample& sample) override { precision.push_back(sample); }
  void on(const recording::records::ImageWritten& image) override { images.push_back(image.stamp.true_time); }
  void on(const recording::records::FeatureUsed& used) override { uses.push_back(used.stamp.true_time); }
  static std::size_t within(const std::vector<TrueTime>& all, double from, double to) {
    std::size_t count = 0;
    for (const TrueTime at : all) {
      const double s = static_cast<double>(at.ns) * 1e-9;
      count += s >= from && s < to;
    }
    return count;
  }
};

struct Cluster {
  Drive drive;
  std::shared_ptr<sensors::WorldScene> scene;
  NodeSetConfig nodes;
  sim::engine::SimulationConfig config;
  int made = 0;  // sets of steps

  explicit Cluster(StrategyKind strategy) : drive("scenarios/paper_scenario1.yaml", strategy) {
    scene = std::make_shared<sensors::WorldScene>(drive.scenario.world, 1, 0, sim::engine::kFirstCycle);
    nodes = {&drive.scenario, &drive.cluster, strategy, 1, 0, scene, nullptr};
    config.cluster = &drive.cluster;
    config.seed = 1;
    config.make_steps = [this](NodeId node) { return ++made, make_steps(nodes, node); };
  }
  NodeId node(const char* name) const { return *drive.cluster.find_node(name); }
};

TrueTime seconds(double s) { return TrueTime{static_cast<std::int64_t>(s * 1e9)}; }

// Away for longer than a round of the cycle counter: it comes back with another cycle number, and the
// precision is still measured.
TEST(Restart, TheFusionNodeComesBackWithNothing) {
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    Cluster cluster(strategy);
    Seen seen;
    sim::engine::ClusterSimulation simulation(cluster.config, seen);
    const int made = cluster.made;
    simulation.run_until(seconds(1.5));
    const auto counts = simulation.counts();
    simulation.power_off(cluster.node("fusion"));
    EXPECT_GE(simulation.counts().overwritten_lists, counts.overwritten_lists) << "what it counted is not forgotten";
    simulation.run_until(seconds(2.5));
    simulation.power_on(cluster.node("fusion"), seconds(2.6));
    simulation.run_until(seconds(5.0));
    EXPECT_EQ(cluster.made, made + 1);
    EXPECT_GT(Seen::within(seen.images, 1.0, 1.5), 5u);
    EXPECT_EQ(Seen::within(seen.images, 1.501, 2.6), 0u);
    EXPECT_GT(Seen::within(seen.images, 4.0, 5.0), 10u);
    ASSERT_GT(seen.precision.size(), 100u);
    std::int64_t cycle = -1;
    for (const recording::records::PrecisionSample& sample : seen.precision) {
      EXPECT_LT(sample.precision, assumed_precision(cluster.drive.cluster.flexray)) << sample.at.ns;
      EXPECT_GT(sample.cycle, cycle);
      cycle = sample.cycle;
    }
    EXPECT_GT(seen.precision.back().at, seconds(4.9));
    EXPECT_LT(simulation.precision(), assumed_precision(cluster.drive.cluster.flexray));
  }
}

TEST(Restart, AColdStartedClusterFuses) {
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    Cluster cluster(strategy);
    RandomStream draw({7, 0, Purpose::kTest, 0, 0});
    std::vector<TrueTime> at;
    for (std::size_t n = 0; n < cluster.drive.cluster.nodes.size(); ++n)
      at.push_back(TrueTime{draw.integer(0, 100'000'000)});
    cluster.config.power_on = [&](NodeId node) { return std::optional(at[index_of(node)]); };
    Seen seen;
    sim::engine::ClusterSimulation simulation(cluster.config, seen);
    EXPECT_EQ(cluster.made, 0) << "no node is there before its supply";
    simulation.run_until(seconds(4.0));
    EXPECT_EQ(cluster.made, static_cast<int>(at.size()));
    for (std::size_t n = 0; n < at.size(); ++n)
      if (cluster.drive.cluster.nodes[n].flexray) {
        EXPECT_NE(simulation.node(static_cast<NodeId>(n)).clock(), nullptr) << cluster.drive.cluster.nodes[n].name;
      }
    EXPECT_GT(Seen::within(seen.uses, 3.0, 4.0), 5u);
    EXPECT_LT(simulation.precision(), assumed_precision(cluster.drive.cluster.flexray));
    EXPECT_GT(seen.precision.size(), 50u);
  }
}

// Nodes of all kinds (hosts, sensor devices, gateways) lose their supply at any instant, again and again.
class Blackouts final : public sim::medium::Disturbance {
 public:
  Blackouts(sim::engine::Plant& plant, std::size_t nodes, std::uint64_t seed)
      : plant_(plant), nodes_(nodes), draw_({seed, 0, Purpose::kTest, 2, 0}) {}
  TrueTime next() const override { return next_; }
  void act(TrueTime now) override {
    const auto node = static_cast<NodeId>(draw_.integer(0, static_cast<std::int64_t>(nodes_) - 1));
    plant_.power_on(node, now + Duration{draw_.integer(0, 1) * draw_.integer(0, 60'000'000)});
    next_ = now + Duration{draw_.integer(0, 40'000'000)};
  }

 private:
  sim::engine::Plant& plant_;
  std::size_t nodes_;
  RandomStream draw_;
  TrueTime next_{500'000'000};
};

std::uint64_t story(StrategyKind strategy, std::uint64_t seed, Duration blackouts_until) {
  Cluster cluster(strategy);
  Seen seen;
  const std::string path = testing::TempDir() + "/blackouts.mcap";
  recording::log::LogWriter log(path, {});
  recording::records::Tee both({&seen, &log});
  sim::engine::ClusterSimulation simulation(cluster.config, both);
  Blackouts blackouts(simulation, cluster.drive.cluster.nodes.size(), seed);
  simulation.set_disturbance(&blackouts);
  simulation.run_until(TrueTime{} + blackouts_until);
  simulation.set_disturbance(nullptr);
  // Left alone it starts again, and works.
  simulation.run_until(simulation.now() + Duration::milliseconds(3'000));
  const double end = static_cast<double>(simulation.now().ns) * 1e-9;
  EXPECT_GT(Seen::within(seen.uses, end - 1.0, end), 5u) << "seed " << seed;
  log.close();
  std::filesystem::remove(path);
  return log.content_hash();
}

TEST(Restart, AClusterSurvivesBlackoutsAndIsAFunctionOfItsSeed) {
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies)
    for (std::uint64_t seed = 0; seed < 3; ++seed)
      EXPECT_EQ(story(strategy, seed, Duration::milliseconds(6'000)),
                story(strategy, seed, Duration::milliseconds(6'000)));
}

}  // namespace
}  // namespace ttf::sim::drives
