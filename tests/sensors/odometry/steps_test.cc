// Odometry on its way through device and host: the list has the vehicle's speed and yaw rate at the strobe's instant.
#include "sensors/odometry/emulator.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "schedules/check/checker.h"
#include "sensors/odometry/preprocessing.h"
#include "sim/drives/scenario.h"

namespace ttf::sensors::odometry {
namespace {

const schedules::model::Task& task_of(const schedules::model::Cluster& cluster, const char* step) {
  for (const schedules::model::Node& node : cluster.nodes)
    for (const schedules::model::Task& task : node.tasks)
      if (task.step == step) return task;
  throw std::logic_error(step);
}

struct Measurements final : recording::records::Sink {
  std::vector<MeasurementId> ids;
  bool wants_frames() const override { return false; }
  using recording::records::Sink::on;
  void on(const recording::records::Measured& measured) override {
    ids.push_back(measured.id);
    EXPECT_TRUE(measured.truth_ids.empty());
  }
};

TEST(OdometrySteps, HandOnSpeedAndYawRate) {
  const sim::drives::Scenario scenario = sim::drives::load_scenario(TTF_SOURCE_DIR "/scenarios/turning_ego.yaml");
  const schedules::model::Cluster cluster =
      schedules::check::load_checked_cluster(TTF_SOURCE_DIR "/schedules/moving_synchronised.yaml");
  const SensorId sensor = *cluster.find_sensor("odometry");
  const auto scene = std::make_shared<WorldScene>(scenario.world, 1, 0, TrueTime{} + Duration::milliseconds(10));
  const auto &measure = task_of(cluster, "odometry_emulator"), &preprocess = task_of(cluster, "odometry_preprocessing");
  OdometryEmulator device({&cluster, &measure, sensor, scene, 1, 0}, {});
  OdometryPreprocessing host(cluster, preprocess, {.speed_sigma_mps = 0.0504, .yaw_rate_sigma_radps = 0.002});

  const TrueTime at = TrueTime{} + Duration::milliseconds(2510);
  Measurements sink;
  const auto &raw_layout = cluster.pdu(measure.writes[0].pdu), &layout = cluster.pdu(preprocess.writes[0].pdu);
  std::array<nodes::host::Output, 1> raw{nodes::host::Output("raw", measure.writes[0].pdu, raw_layout)},
      out{nodes::host::Output("odometry", preprocess.writes[0].pdu, layout)};
  nodes::host::StepContext context;
  context.stamp.true_time = at;
  context.measurement = 7;
  context.outputs = raw;
  context.sink = &sink;
  device.run(context);
  ASSERT_EQ(sink.ids.size(), 1u);
  EXPECT_EQ(sink.ids[0], (MeasurementId{sensor, 7}));

  std::vector<nodes::host::StrobeLatch> strobes(cluster.sensors.size());
  const GlobalTime strobe = GlobalTime{} + Duration::milliseconds(400);
  strobes[index_of(sensor)].strobe(7, strobe);
  std::array<nodes::host::Input, 1> inputs{
      nodes::host::Input{"raw", measure.writes[0].pdu, &raw_layout, raw[0].view(), true}};
  nodes::host::StepContext hosts;
  hosts.inputs = inputs;
  hosts.outputs = out;
  hosts.strobes = strobes;
  hosts.sink = &sink;
  host.run(hosts);
  ASSERT_TRUE(out[0].written());
  const bus::cni::ListView list = out[0].view();
  EXPECT_EQ(list.sequence, 7u);
  EXPECT_EQ(nodes::host::time_stamp(layout, list, strobe, cluster.round()), strobe);
  ASSERT_EQ(nodes::host::element_count(layout, list), 1);
  const sim::world::EgoState ego = scene->ego_at(at);
  EXPECT_NEAR(ego.yaw_rate, 0.4, 0.01);
  const auto value = [&](const char* name) {
    return nodes::host::element_value(layout, list, 0, *schedules::model::find_signal(layout.element, name));
  };
  EXPECT_NEAR(value("speed"), ego.vx, 5.0 * 0.05 + 0.005);
  EXPECT_NEAR(value("yaw_rate"), ego.yaw_rate, 5.0 * 0.002 + 2e-4);
  EXPECT_NEAR(value("sigma_speed"), 0.051, 1e-9) << "never understated";
  EXPECT_NEAR(value("sigma_yaw_rate"), 0.002, 1e-9);
}

}  // namespace
}  // namespace ttf::sensors::odometry
