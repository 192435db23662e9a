#include "schedules/model/ports.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/errors.h"
#include "tests/support/refusals.h"

namespace ttf::schedules::model {
namespace {

Cluster with_ports() {
  Cluster cluster;
  cluster.file = "small.yaml";
  cluster.pdus.resize(2);
  cluster.pdus[0].name = "laser_objects";
  cluster.pdus[0].sensor = SensorId{0};
  cluster.pdus[1].name = "camera_objects";
  cluster.pdus[1].sensor = SensorId{1};
  cluster.sensors.resize(2);
  cluster.sensors[0].name = "laser";
  cluster.sensors[1].name = "camera";
  Task task;
  task.name = "fuse";
  task.step = "fusion";
  task.line = 7;
  task.reads = {{"laser", PduId{0}, kFlexRay, 8}};
  Task other;
  other.name = "forward";
  other.step = "gateway";
  other.line = 12;
  other.reads = {{"in", PduId{0}, kFlexRay, 13}};
  other.writes = {{"out", PduId{0}, kFlexRay, 14}};
  cluster.nodes.resize(1);
  cluster.nodes[0].name = "all";
  cluster.nodes[0].tasks = {task, other};
  return cluster;
}

const std::vector<StepPorts> kSteps{{"fusion", {}, {}, true}, {"gateway", {"in"}, {"out"}, false}};

std::vector<Finding> port_findings(const Cluster& cluster) {
  return support::findings_of([&] { bind_ports(cluster, kSteps); });
}

TEST(Ports, FitBothWays) { EXPECT_TRUE(port_findings(with_ports()).empty()); }

TEST(Ports, UnknownStep) {
  Cluster cluster = with_ports();
  cluster.nodes[0].tasks[1].step = "gatevay";
  const auto findings = port_findings(cluster);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].line, 12);
  EXPECT_EQ(findings[0].value, "gatevay");
  EXPECT_NE(findings[0].expected.find("fusion, gateway"), std::string::npos);
}

TEST(Ports, ALibrarysPortsAreFreeButItsNameIsAFiles) {
  Cluster cluster = with_ports();
  Task& task = cluster.nodes[0].tasks[1];
  task.step = "distance.so";
  task.writes[0].port = "anything";
  EXPECT_TRUE(port_findings(cluster).empty());
  for (const char* name : {".so", "../distance.so", "/lib/distance.so", "a/b.so"}) {
    task.step = name;
    ASSERT_EQ(port_findings(cluster).size(), 1u) << name;
    EXPECT_EQ(port_findings(cluster)[0].sentence(),
              std::string("small.yaml:12: nodes.all.tasks.forward.step = ") + name +
                  ": must be a file name without a folder and control characters, such as distance.so: "
                  "--steps gives the folder");
  }
  for (const char c : {'\0', '\n', '\x7f'}) {
    task.step = std::string("dist") + c + "ance.so";
    EXPECT_EQ(port_findings(cluster).size(), 1u) << static_cast<int>(c);
  }
}

TEST(Ports, PortTheCodeNeedsIsMissingAndPortItDoesNotHaveIsThere) {
  Cluster cluster = with_ports();
  cluster.nodes[0].tasks[1].writes[0].port = "exit";
  const auto findings = port_findings(cluster);
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_NE(findings[0].expected.find("must bind the port out"), std::string::npos);
  EXPECT_EQ(findings[1].line, 14);
  EXPECT_NE(findings[1].expected.find("is not a port"), std::string::npos);
}

TEST(Ports, ASensorsPortLeadsToAPduOfThatSensor) {
  Cluster cluster = with_ports();
  cluster.nodes[0].tasks[0].reads = {{"camera", PduId{1}, kFlexRay, 8}, {"laser", PduId{1}, kFlexRay, 9}};
  const auto findings = port_findings(cluster);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(
      findings[0].sentence(),
      "small.yaml:9: nodes.all.tasks.fuse.reads.laser = camera_objects: must be a PDU of the sensor laser, as its port "
      "is called");
}

TEST(Ports, FusionReadsSensorsOnlyAndAtLeastOne) {
  Cluster cluster = with_ports();
  cluster.nodes[0].tasks[0].reads[0].port = "sonar";
  ASSERT_EQ(port_findings(cluster).size(), 1u);
  EXPECT_EQ(port_findings(cluster)[0].key, "nodes.all.tasks.fuse.reads.sonar");
  cluster.nodes[0].tasks[0].reads.clear();
  ASSERT_EQ(port_findings(cluster).size(), 1u);
  EXPECT_NE(port_findings(cluster)[0].expected.find("at least one"), std::string::npos);
}

}  // namespace
}  // namespace ttf::schedules::model
