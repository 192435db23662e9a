#include "schedules/model/ports.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/errors.h"

namespace ttf::schedules::model {
namespace {

constexpr std::string_view kLibraryEnd = ".so", kObjects = "_objects";

struct Direction {
  std::string_view key;  // "reads" or "writes"
  const std::vector<PortBinding>& bound;
  const PortNames& needed;
  bool any;  // the names of sensors are ports too
  const PortNames& optional;
};

std::string sensors_names(const Direction& direction) {
  if (!direction.any) return {};
  return direction.key == "reads" ? "the sensors' names" : fmt::format("the sensors' names with {} behind", kObjects);
}

std::string others(const PortNames& optional) {
  return optional.empty() ? std::string() : fmt::format(", and {}", fmt::join(optional, ", "));
}

// Returns the sensor after which a port is called.
std::optional<SensorId> sensor_of(const Cluster& cluster, const Direction& direction, std::string_view port) {
  if (!direction.any) return std::nullopt;
  if (direction.key == "reads") return cluster.find_sensor(port);
  return port.ends_with(kObjects) ? cluster.find_sensor(port.substr(0, port.size() - kObjects.size())) : std::nullopt;
}

void bind_direction(const Cluster& cluster, const std::string& path, const Task& task, const Direction& direction,
                    Findings& findings) {
  for (const std::string_view port : direction.needed)
    if (std::none_of(direction.bound.begin(), direction.bound.end(),
                     [&](const PortBinding& binding) { return binding.port == port; }))
      findings.add(cluster.finding(task.line, fmt::format("{}.{}", path, direction.key), "",
                                   fmt::format("must bind the port {}: step {} needs it", port, task.step)));
  for (const PortBinding& binding : direction.bound) {
    const bool known = direction.needed.contains(binding.port) || direction.optional.contains(binding.port);
    const auto sensor = sensor_of(cluster, direction, binding.port);
    const std::string key = fmt::format("{}.{}.{}", path, direction.key, binding.port);
    if (sensor && !known && cluster.pdu(binding.pdu).sensor != *sensor)
      findings.add(cluster.finding(
          binding.line, key, cluster.pdu(binding.pdu).name,
          fmt::format("must be a PDU of the sensor {}, as its port is called", cluster.sensor(*sensor).name)));
    if (known || sensor) continue;
    findings.add(cluster.finding(
        binding.line, key, "",
        fmt::format("is not a port of step {} (ports: {}{})", task.step, fmt::join(direction.needed, ", "),
                    sensors_names(direction) + others(direction.optional))));
  }
  if (direction.any && direction.bound.empty())
    findings.add(cluster.finding(
        task.line, fmt::format("{}.{}", path, direction.key), "",
        fmt::format("must bind at least one sensor's list: step {} {} them", task.step, direction.key)));
}

// A zero would end the name for the system, and other control characters would hide it from the reader.
bool no_file_name_has(char c) { return c == '/' || static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

}  // namespace

std::string written_port(std::string_view sensor) { return std::string(sensor).append(kObjects); }

std::vector<const PortBinding*> camera_ports(const Task& task) {
  std::vector<const PortBinding*> ports;
  for (const PortBinding& read : task.reads)
    if (std::ranges::find(task.writes, written_port(read.port), &PortBinding::port) != task.writes.end())
      ports.push_back(&read);
  return ports;
}

bool names_library(std::string_view step) { return step.ends_with(kLibraryEnd); }

void bind_ports(const Cluster& cluster, std::span<const StepPorts> steps) {
  Findings findings;
  std::vector<std::string_view> names;
  for (const StepPorts& step : steps) names.push_back(step.step);
  for (const Node& node : cluster.nodes)
    for (const Task& task : node.tasks) {
      const std::string path = fmt::format("nodes.{}.tasks.{}", node.name, task.name);
      if (names_library(task.step)) {
        if (task.step.size() == kLibraryEnd.size() || std::ranges::any_of(task.step, no_file_name_has))
          findings.add(
              cluster.finding(task.line, path + ".step", task.step,
                              "must be a file name without a folder and control characters, such as distance.so: "
                              "--steps gives the folder"));
        continue;
      }
      const auto step = std::find_if(steps.begin(), steps.end(),
                                     [&](const StepPorts& candidate) { return candidate.step == task.step; });
      if (step == steps.end()) {
        findings.add(cluster.finding(task.line, path + ".step", task.step,
                                     fmt::format("must be one of {}, or a library's file name that ends in {}",
                                                 fmt::join(names, ", "), kLibraryEnd)));
        continue;
      }
      bind_direction(cluster, path, task, {"reads", task.reads, step->reads, step->any_reads, step->may_read},
                     findings);
      bind_direction(cluster, path, task, {"writes", task.writes, step->writes, step->any_writes, step->may_write},
                     findings);
    }
  findings.throw_if_any();
}

}  // namespace ttf::schedules::model
