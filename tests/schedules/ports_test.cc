#include "schedules/ports.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/errors.h"

namespace ttf::schedules {
namespace {

Cluster small() {
  Cluster cluster;
  cluster.file = "small.yaml";
  cluster.pdus.resize(1);
  cluster.sensors.resize(1);
  cluster.sensors[0].name = "laser";
  Task task;
  task.name = "fuse";
  task.step = "fusion";
  task.line = 7;
  task.reads = {{"laser", PduId{0}, std::nullopt, 8}};
  Task other;
  other.name = "forward";
  other.step = "gateway";
  other.line = 12;
  other.reads = {{"in", PduId{0}, std::nullopt, 13}};
  other.writes = {{"out", PduId{0}, std::nullopt, 14}};
  cluster.nodes.resize(1);
  cluster.nodes[0].name = "all";
  cluster.nodes[0].tasks = {task, other};
  return cluster;
}

const std::vector<StepPorts> kSteps{{"fusion", {}, {}, true}, {"gateway", {"in"}, {"out"}, false}};

std::vector<Finding> findings_of(const Cluster& cluster) {
  try {
    bind_ports(cluster, kSteps);
  } catch (const InputError& error) {
    return error.findings();
  }
  return {};
}

TEST(Ports, FitBothWays) { EXPECT_TRUE(findings_of(small()).empty()); }

TEST(Ports, UnknownStep) {
  Cluster cluster = small();
  cluster.nodes[0].tasks[1].step = "gatevay";
  const auto findings = findings_of(cluster);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].line, 12);
  EXPECT_EQ(findings[0].value, "gatevay");
  EXPECT_NE(findings[0].expected.find("fusion, gateway"), std::string::npos);
}

TEST(Ports, PortTheCodeNeedsIsMissingAndPortItDoesNotHaveIsThere) {
  Cluster cluster = small();
  cluster.nodes[0].tasks[1].writes[0].port = "exit";
  const auto findings = findings_of(cluster);
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_NE(findings[0].expected.find("must bind the port out"), std::string::npos);
  EXPECT_EQ(findings[1].line, 14);
  EXPECT_NE(findings[1].expected.find("is not a port"), std::string::npos);
}

TEST(Ports, FusionReadsSensorsOnlyAndAtLeastOne) {
  Cluster cluster = small();
  cluster.nodes[0].tasks[0].reads[0].port = "sonar";
  ASSERT_EQ(findings_of(cluster).size(), 1u);
  EXPECT_EQ(findings_of(cluster)[0].key, "nodes.all.tasks.fuse.reads.sonar");
  cluster.nodes[0].tasks[0].reads.clear();
  ASSERT_EQ(findings_of(cluster).size(), 1u);
  EXPECT_NE(findings_of(cluster)[0].expected.find("at least one"), std::string::npos);
}

}  // namespace
}  // namespace ttf::schedules
