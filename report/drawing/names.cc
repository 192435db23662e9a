#include "report/drawing/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "report/drawing/axes.h"

namespace ttf::report::drawing {
namespace {

std::string at(const std::vector<std::string>& list, std::size_t i, const char* what) {
  return i < list.size() && !list[i].empty() ? list[i] : fmt::format("{} {}", what, i);
}

std::string lower(std::string s) {
  std::ranges::transform(s, s.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return s;
}

}  // namespace

std::string Names::node(NodeId id) const { return at(nodes, index_of(id), "node"); }
std::string Names::pdu(PduId id) const { return id == kNoPdu ? "status" : at(pdus, index_of(id), "pdu"); }
std::string Names::sensor(SensorId id) const { return at(sensors, index_of(id), "sensor"); }
std::string Names::can_bus(std::size_t index) const { return at(can_buses, index, "CAN"); }

std::string Names::task(NodeId node, std::uint8_t task) const {
  return index_of(node) < tasks.size() ? at(tasks[index_of(node)], task, "task") : fmt::format("task {}", task);
}

SensorId Names::sensor_of(PduId id) const {
  if (id == kNoPdu) return kNoSensor;
  if (!pdu_sensors.empty()) return index_of(id) < pdu_sensors.size() ? pdu_sensors[index_of(id)] : kNoSensor;
  const std::string name = lower(pdu(id));
  for (std::size_t s = 0; s < sensors.size(); ++s)
    if (!sensors[s].empty() && name.find(lower(sensors[s])) != std::string::npos) return SensorId(s);
  return kNoSensor;
}

Names names_of(const schedules::model::Cluster& cluster) {
  Names names;
  for (const auto& node : cluster.nodes) {
    names.nodes.push_back(node.name);
    names.tasks.emplace_back();
    for (const auto& task : node.tasks) names.tasks.back().push_back(task.name);
  }
  for (const auto& pdu : cluster.pdus) {
    names.pdus.push_back(pdu.name);
    names.pdu_sensors.push_back(pdu.sensor);
  }
  for (const auto& sensor : cluster.sensors) names.sensors.push_back(sensor.name);
  for (const auto& bus : cluster.can_buses) names.can_buses.push_back(bus.name);
  return names;
}

Names names_of(const recording::log::LogManifest& manifest) {
  Names names;
  names.drive = fmt::format("{}, {}", manifest.scenario_name, manifest.strategy);
  names.nodes = manifest.node_names;
  names.tasks = manifest.task_names;
  names.pdus = manifest.pdu_names;
  names.sensors = manifest.sensor_names;
  names.can_buses = manifest.can_bus_names;
  names.pdu_sensors = manifest.pdu_sensors;
  return names;
}

SensorLook look_of(const std::string& sensor_name) {
  const std::string name = lower(sensor_name);
  const auto contains = [&](const char* part) { return name.find(part) != std::string::npos; };
  if (contains("laser") || contains("lidar") || contains("lsc")) return SensorLook::kLaser;
  if (contains("camera") || contains("stereo") || contains("scabor")) return SensorLook::kCamera;
  return contains("radar") ? SensorLook::kRadar : SensorLook::kOther;
}

std::string sensor_colour(const Names& names, SensorId sensor) {
  switch (look_of(names.sensor(sensor))) {
    case SensorLook::kLaser: return std::string(kVermilion);
    case SensorLook::kCamera: return std::string(kBlue);
    case SensorLook::kRadar: return std::string(kGreen);
    case SensorLook::kOther: break;
  }
  const std::string others[] = {std::string(kPurple), std::string(kSkyBlue), std::string(kOrange)};
  return others[index_of(sensor) % 3];
}

// A PDU without a sensor gets a colour that the sensors leave free.
std::string pdu_colour(const Names& names, PduId pdu) {
  if (pdu == kNoPdu) return std::string(kStatusFrame);
  if (const SensorId sensor = names.sensor_of(pdu); sensor != kNoSensor) return sensor_colour(names, sensor);
  constexpr std::array<std::string_view, 3> rest{kPurple, kSkyBlue, kOrange};
  std::size_t nth = 0;
  for (std::size_t p = 0; p < index_of(pdu); ++p) nth += names.sensor_of(PduId(p)) == kNoSensor ? 1u : 0u;
  return tint(rest[nth % rest.size()], nth >= rest.size() ? 0.4 : 0.0);
}

}  // namespace ttf::report::drawing
