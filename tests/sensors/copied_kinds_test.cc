// Sensors that are like another one, but of another kind: in a cluster file and in a plan their lists are those that the steps
// of the kind take.
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "schedules/file/likeness/layouts.h"
#include "sensors/kinds/sensors.h"
#include "sensors/observation_codec.h"
#include "sim/drives/scenario.h"
#include "tests/schedules/cluster_dump.h"
#include "tests/schedules/cluster_file.h"
#include "tests/schedules/synthesis/plans.h"

namespace ttf::sensors {
namespace {

using schedules::file::likeness::known_layouts;
using schedules::model::Cluster;
using schedules::model::PduLayout;
using schedules::model::SensorKind;

class CopiedKinds : public testing::TestWithParam<SensorKind> {
 protected:
  static std::string entry() { return "rear: {like: laser, kind: " + std::string(row_of(GetParam()).word) + "}"; }
};

// Makes the steps of the sensor's device and host, and decodes its list.
void expect_steps(const Cluster& cluster, SensorKind kind) {
  const sim::drives::Scenario scenario = sim::drives::load_scenario(TTF_SOURCE_DIR "/scenarios/paper_scenario1.yaml");
  const auto scene = std::make_shared<WorldScene>(scenario.world, 1, 0, TrueTime{});
  const SensorId rear = *cluster.find_sensor("rear");
  const schedules::model::Sensor& sensor = cluster.sensor(rear);
  EXPECT_EQ(sensor.kind, kind);
  for (const NodeId node : {sensor.device, sensor.host}) {
    ASSERT_EQ(cluster.node(node).tasks.size(), 1u);
    const schedules::model::Task& task = cluster.node(node).tasks[0];
    EXPECT_NE(kinds::make_step(scenario.sensors, {&cluster, &task, rear, scene, 1, 0}), nullptr) << task.step;
    if (node == sensor.host) {
      EXPECT_NO_THROW(ObservationCodec(cluster, task.writes[0].pdu));
    }
  }
}

TEST_P(CopiedKinds, PassTheCheckInAClusterFile) {
  const std::string text =
      support::replaced(schedules::shipped_text("paper_planned"), "\nsensors:\n", "\nsensors:\n  " + entry() + "\n");
  ASSERT_EQ(schedules::sentences(schedules::findings_of(text)), "");
  expect_steps(schedules::file::parse_cluster(text, "copy.yaml"), GetParam());
}

TEST_P(CopiedKinds, StandInAPlan) {
  using namespace schedules::synthesis;
  const std::string text = changed(plan_text("paper"), "  objective:", "  sensors: {" + entry() + "}\n  objective:");
  ASSERT_EQ(schedules::sentences(plan_findings(text)), "");
  plan::Plan made = plan::parse_plan(text, "plan.yaml");
  made.cluster.pdus = made.unchanging->pdus;  // with their signals
  expect_steps(made.cluster, GetParam());
}

std::vector<SensorKind> kinds_with_copies() {
  std::vector<SensorKind> kinds;
  for (const schedules::model::SensorKindRow& row : schedules::model::kSensorKinds)
    if (row.observes) kinds.push_back(row.kind);
  return kinds;
}
INSTANTIATE_TEST_SUITE_P(Kinds, CopiedKinds, testing::ValuesIn(kinds_with_copies()),
                         [](const auto& parameter) { return std::string(row_of(parameter.param).word); });

// All but the names.
std::string layout_text(const PduLayout& layout) {
  return schedules::dump("header", layout.header) + schedules::dump("element", layout.element) +
         std::to_string(layout.fragment_bytes) + " " + std::to_string(layout.elements_per_fragment);
}

TEST(KnownLayouts, AreThoseOfShippedClusters) {
  std::set<std::string> shipped;
  for (const std::string& name : schedules::shipped_clusters())
    for (const PduLayout& layout : schedules::file::load_cluster(schedules::shipped_path(name)).pdus)
      shipped.insert(layout_text(layout));
  for (const SensorKind kind : kinds_with_copies()) {
    const auto known = known_layouts(kind);
    ASSERT_TRUE(known) << row_of(kind).word;
    for (const PduLayout& list : {known->raw, known->objects})
      EXPECT_TRUE(shipped.contains(layout_text(list))) << row_of(kind).word << layout_text(list);
  }
}

}  // namespace
}  // namespace ttf::sensors
