// A cluster small enough to work out by hand. One cycle is 5 ms, slots last 84 us, oscillators are exact.
// Clocks differ by at most 6.85 us (assumed precision) and a macrotick. With rounding, this makes 7851 ns on
// every bound.
//
//   device: measure 1 ms -> list in slot 3 of every cycle (168..252 us)
//   fusion: fuse 2 ms at 1 ms of odd cycles; publish 0.1 ms at the start of even cycles -> image in slot 4 there
//   user:   use at 0.5 ms of even cycles
#pragma once

#include <string>
#include <utility>

#include "schedules/model/cluster.h"

namespace ttf::schedules {

inline constexpr std::int64_t kClocks = 7851, kApart = 7850, kRounding = 101;

inline model::Task timed(std::string name, model::CycleInstant at, Duration execution) {
  model::Task task;
  task.name = std::move(name);
  task.activation.at = at;
  task.best_case = task.worst_case = execution;
  return task;
}

inline model::Cluster small(bool scheduled) {
  model::Cluster cluster;
  cluster.flexray.gNumberOfStaticSlots = 20;
  cluster.pdus.resize(2);
  for (model::PduLayout& layout : cluster.pdus) {
    layout.fragment_bytes = 56;
    layout.max_elements = layout.elements_per_fragment = 1;
  }
  cluster.pdus[0].sensor = SensorId{0};
  cluster.nodes.resize(3);
  for (model::Node& node : cluster.nodes) {
    node.flexray.emplace();
    node.drift_ppb = 0;
  }
  model::Task measure = timed("measure", {}, Duration::milliseconds(1));
  measure.activation.kind = model::ActivationKind::kSensor;
  measure.activation.sensor = SensorId{0};
  measure.writes = {{"raw", PduId{0}, model::kFlexRay, 0}};
  cluster.nodes[0].tasks = {measure};
  model::Task fuse = timed("fuse", {1, 2, Macroticks{1000}}, Duration::milliseconds(2));
  fuse.reads = {{"s", PduId{0}, model::kFlexRay, 0}};
  model::Task publish = timed("publish", {0, 2, Macroticks{0}}, Duration::microseconds(100));
  publish.writes = {{"image", PduId{1}, model::kFlexRay, 0}};
  cluster.nodes[1].tasks = {fuse, publish};
  model::Task use = timed("use", {0, 2, Macroticks{500}}, Duration::microseconds(100));
  use.reads = {{"image", PduId{1}, model::kFlexRay, 0}};
  cluster.nodes[2].tasks = {use};
  cluster.frames = {{3, model::Channels::kAB, 0, 1, NodeId{0}, PduId{0}, 0, 0},
                    {4, model::Channels::kAB, 0, 2, NodeId{1}, PduId{1}, 0, 0}};
  model::Sensor sensor;
  sensor.name = "s";
  sensor.scheduled = scheduled;
  sensor.period = Duration::milliseconds(10);
  sensor.at = {0, 2, Macroticks{0}};
  cluster.sensors = {sensor};
  return cluster;
}

}  // namespace ttf::schedules
