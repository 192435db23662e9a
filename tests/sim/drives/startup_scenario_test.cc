// A scenario's options for the start of its drive.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "sim/drives/startup.h"
#include "tests/bus/bus_rig.h"
#include "tests/support/refusals.h"

namespace ttf::sim::drives {
namespace {

Startup startup_of(const std::string& yaml) {
  const StrictYaml file = StrictYaml::parse(yaml, "drive.yaml");
  Findings findings;
  YamlMap root = file.root(findings);
  Startup startup = load_startup(root, Duration::milliseconds(3'000));
  root.finish();
  findings.throw_if_any();
  return startup;
}

std::string refusal(const std::string& yaml) {
  return support::refusal_of([&] { startup_of(yaml); });
}

// Nodes node0 .. node3 on FlexRay, and a device off it.
schedules::model::Cluster five() {
  schedules::model::Cluster cluster = bus::small_cluster(4);
  cluster.file = "cluster.yaml";
  schedules::model::Node device;
  device.name = "device";
  cluster.nodes.push_back(device);
  return cluster;
}

std::string refusal(const Startup& startup, const schedules::model::Cluster& cluster) {
  return support::refusal_of([&] { node_starts(startup, cluster, 1, 0); });
}

TEST(StartupScenario, BeginsIntegratedByDefault) {
  EXPECT_FALSE(startup_of("{}").cold);
  EXPECT_FALSE(startup_of("startup: integrated").cold);
  EXPECT_FALSE(startup_of("startup: {kind: integrated}").cold);
  const Startup cold = startup_of("startup: {kind: cold}");
  EXPECT_TRUE(cold.cold);
  EXPECT_EQ(cold.spread, Duration::milliseconds(20));
  EXPECT_TRUE(cold.power_on.empty());
  EXPECT_EQ(cold.wake_up, "");
}

TEST(StartupScenario, TakesTimesByNodeAndWhoWakes) {
  const Startup startup = startup_of(
      "startup:\n  kind: cold\n  spread: 5 ms\n  wake_up: node1\n  power_on: {node0: 1500 us, node2: 0 ms}\n");
  EXPECT_EQ(startup.spread, Duration::milliseconds(5));
  EXPECT_EQ(startup.wake_up, "node1");
  ASSERT_EQ(startup.power_on.size(), 2u);
  EXPECT_EQ(startup.power_on[0].node, "node0");
  EXPECT_EQ(startup.power_on[0].after, Duration::microseconds(1500));
  EXPECT_EQ(startup.power_on[1].node, "node2");
  EXPECT_EQ(startup.power_on[1].after, Duration{});
}

TEST(StartupScenario, SaysWhatIsWrongWithFileLineKeyAndRange) {
  for (const auto& [yaml, complaint] : {
           std::pair{"startup: cold", "drive.yaml:1: startup = cold: must be a mapping with kind: cold, or integrated"},
           std::pair{"startup: warm", "drive.yaml:1: startup = warm: must be a mapping with kind: cold, or integrated"},
           std::pair{"startup: [cold]", "drive.yaml:1: startup: must be a mapping with kind: cold, or integrated"},
           std::pair{"startup: {spread: 1 ms}", "startup.kind"},
           std::pair{"startup: {kind: cold, spread: 4 s}", "startup.spread"},
           std::pair{"startup: {kind: cold, spread: -1 ms}", "startup.spread"},
           std::pair{"startup: {kind: cold, power_on: {a: soon}}", "startup.power_on.a"},
           std::pair{"startup: {kind: cold, power_on: [1 ms]}", "startup.power_on"},
           std::pair{"startup: {kind: cold, sleepers: a}", "startup.sleepers"},
           std::pair{"startup: {kind: integrated, spread: 1 ms}", "startup.spread"},
       })
    EXPECT_NE(refusal(yaml).find(complaint), std::string::npos) << yaml << ": " << refusal(yaml);
}

TEST(StartupScenario, DrawsWithinTheSpreadWhatItDoesNotSay) {
  Startup startup;
  startup.cold = true;
  startup.spread = Duration::milliseconds(7);
  startup.power_on = {{"node2", Duration::milliseconds(40), 3}};
  std::vector<Duration> drawn;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto starts = node_starts(startup, five(), seed, 0);
    ASSERT_EQ(starts.size(), 5u);
    for (std::size_t n = 0; n < 5; ++n) {
      EXPECT_EQ(starts[n].how, nodes::host::ColdStart::kStarts);
      if (n == 2) {
        EXPECT_EQ(starts[n].after, Duration::milliseconds(40));
        continue;
      }
      EXPECT_GE(starts[n].after, Duration{});
      EXPECT_LE(starts[n].after, startup.spread);
      drawn.push_back(starts[n].after);
    }
    EXPECT_EQ(node_starts(startup, five(), seed, 0)[1].after, starts[1].after) << "the same seed, the same draw";
  }
  std::sort(drawn.begin(), drawn.end());
  EXPECT_LT(drawn.front(), Duration::microseconds(200));
  EXPECT_GT(drawn.back(), Duration::microseconds(6'800));
  EXPECT_GT(std::unique(drawn.begin(), drawn.end()) - drawn.begin(), 790);
}

// node1 wakes on channel A. node3 is on B alone, the device on no FlexRay: they cannot be woken.
TEST(StartupScenario, OtherNodesOnTheWakeupChannelSleep) {
  schedules::model::Cluster cluster = five();
  cluster.nodes[1].flexray->pWakeupChannel = schedules::model::Channel::kA;
  cluster.nodes[3].flexray->pChannels = schedules::model::Channels::kB;
  Startup startup;
  startup.cold = true;
  startup.wake_up = "node1";
  std::vector<nodes::host::ColdStart> how;
  for (const nodes::host::NodeStart& start : node_starts(startup, cluster, 1, 0)) how.push_back(start.how);
  using enum nodes::host::ColdStart;
  EXPECT_EQ(how, (std::vector<nodes::host::ColdStart>{kSleeps, kWakes, kSleeps, kStarts, kStarts}));
}

TEST(StartupScenario, NamesAreThoseOfTheCluster) {
  Startup startup;
  startup.file = "drive.yaml";
  startup.power_on = {{"nobody", {}, 7}, {"node0", {}, 7}};
  EXPECT_NE(refusal(startup, five()).find("drive.yaml:7: startup.power_on = nobody: is not a node of cluster.yaml"),
            std::string::npos)
      << refusal(startup, five());
  startup.power_on.clear();
  startup.wake_up = "nobody";
  EXPECT_NE(refusal(startup, five()).find("is not a node of cluster.yaml"), std::string::npos);
  startup.wake_up = "device";
  EXPECT_NE(refusal(startup, five()).find("must be on FlexRay"), std::string::npos);
  startup.wake_up = "node1";
  schedules::model::Cluster other_channel = five();
  other_channel.nodes[1].flexray->pChannels = schedules::model::Channels::kA;
  other_channel.nodes[1].flexray->pWakeupChannel = schedules::model::Channel::kB;
  EXPECT_NE(refusal(startup, other_channel).find("must be attached to its wake-up channel"), std::string::npos);
  EXPECT_EQ(refusal(startup, five()), "");
}

}  // namespace
}  // namespace ttf::sim::drives
