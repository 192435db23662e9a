// A small cluster built in code: fourteen slots in a 5 ms cycle, some multiplexed, on one or both channels.
#pragma once

#include "schedules/model/cluster.h"

namespace ttf::report {

inline schedules::model::Cluster synthetic_cluster() {
  using namespace schedules::model;
  schedules::model::Cluster c;
  c.name = "synthetic";
  c.flexray.gNumberOfStaticSlots = 40;
  c.flexray.gNumberOfMinislots = 200;
  c.flexray.gdMinislot = 5;
  const auto pdu = [&](const char* name, SensorId sensor, int elements) {
    schedules::model::PduLayout layout;
    layout.name = name;
    layout.sensor = sensor;
    layout.max_elements = elements;
    layout.elements_per_fragment = 5;
    c.pdus.push_back(layout);
  };
  pdu("laser_objects", SensorId{0}, 25);
  pdu("camera_objects", SensorId{1}, 25);
  pdu("image", kNoSensor, 25);
  const auto task = [](const char* name, int offset, int repetition, std::int64_t worst_us) {
    schedules::model::Task t;
    t.name = name;
    t.activation.at = {0, repetition, Macroticks{offset}};
    t.best_case = Duration::microseconds(worst_us / 2);
    t.worst_case = Duration::microseconds(worst_us);
    return t;
  };
  schedules::model::Node gateway, fusion, feature;
  gateway.name = "gateway";
  gateway.tasks = {task("forward_laser", 4300, 1, 100)};
  gateway.tasks[0].activation.kind = schedules::model::ActivationKind::kMessage;
  gateway.tasks[0].activation.port = "objects";
  gateway.tasks[0].reads = {{"objects", PduId{0}, schedules::model::kFlexRay, 0}};
  fusion.name = "fusion";
  fusion.tasks = {task("track", 3500, 2, 3000), task("image", 2000, 8, 400)};
  feature.name = "feature";
  feature.tasks = {task("serve", 1500, 8, 900)};
  c.nodes = {gateway, fusion, feature};
  schedules::model::Sensor laser, camera;
  laser.name = "laser";
  laser.scheduled = true;
  laser.at = {3, 16, Macroticks{1000}};
  camera.name = "camera";
  c.sensors = {laser, camera};
  const auto frame = [&](int slot, schedules::model::Channels channels, int base, int repetition, int node, PduId id,
                         int fragment) {
    c.frames.push_back({slot, channels, base, repetition, NodeId(static_cast<std::uint8_t>(node)), id, fragment, 0});
  };
  for (int s = 1; s <= 3; ++s) frame(s, schedules::model::Channels::kAB, 0, 1, s - 1, kNoPdu, 0);
  for (int s = 4; s <= 8; ++s)
    frame(s, schedules::model::Channels::kA, 0, 2, 0, PduId{0}, s - 4),
        frame(s, schedules::model::Channels::kB, 0, 2, 0, PduId{1}, s - 4);
  for (int s = 20; s <= 24; ++s) frame(s, schedules::model::Channels::kAB, 1, 8, 1, PduId{2}, s - 20);
  return c;
}

}  // namespace ttf::report
