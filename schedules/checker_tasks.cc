// The checker's rules about tasks, and about where lists come from and go to.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "schedules/checker.h"

namespace ttf::schedules {
namespace {

std::string task_path(const Node& node, const Task& task) {
  return fmt::format("nodes.{}.tasks.{}", node.name, task.name);
}

std::string ms(Duration d) { return fmt::format("{} ms", static_cast<double>(d.ns) * 1e-6); }

// Do two periodic intervals, each shorter than its period, meet? Their starts differ by `distance` modulo the shorter
// period: repetitions are powers of two.
bool meet(const GlobalParameters& flexray, const Task& a, const Task& b) {
  const CycleInstant &x = a.activation.at, &y = b.activation.at;
  const std::int64_t cycle_ns = flexray.cycle_ps() / 1000;
  const std::int64_t period = cycle_ns * std::min(x.repetition, y.repetition);
  const std::int64_t start_a = time_of(flexray, x.base_cycle, x.offset).ns;
  const std::int64_t start_b = time_of(flexray, y.base_cycle, y.offset).ns;
  const std::int64_t from_a = ((start_b - start_a) % period + period) % period;   // a's start to the next start of b
  return from_a < a.worst_case.ns || period - from_a < b.worst_case.ns;
}

// The shortest time between two lists on the medium of a binding.
Duration shortest_period(const Cluster& cluster, const PortBinding& binding) {
  if (binding.can_bus) {
    for (const CanMessage& message : cluster.can_buses[*binding.can_bus].messages)
      if (message.pdu == binding.pdu) return message.shortest_period;
    return {};
  }
  int repetition = 64;
  for (const FrameSlot& frame : cluster.frames)
    if (frame.pdu == binding.pdu) repetition = std::min(repetition, frame.repetition);
  return cluster.cycle() * repetition;
}

void check_activation(const Cluster& cluster, NodeId id, const Task& task, ClusterFindings& findings) {
  const Node& node = cluster.node(id);
  const std::string path = task_path(node, task);
  switch (task.activation.kind) {
    case ActivationKind::kTime: {
      if (!node.flexray)
        findings.at(task.line, path + ".activation", "time", "needs a node on FlexRay: there is no global time elsewhere");
      const Duration period = cluster.cycle() * task.activation.at.repetition;
      if (task.deadline > period)
        findings.at(task.line, path + ".deadline", ms(task.deadline),
                    fmt::format("must be at most the task's period, {}", ms(period)));
      if (task.worst_case > period)
        findings.at(task.line, path + ".worst_case", ms(task.worst_case),
                    fmt::format("must be at most the task's period, {}: it overlaps itself", ms(period)));
      break;
    }
    case ActivationKind::kMessage: {
      const auto read = std::find_if(task.reads.begin(), task.reads.end(), [&](const PortBinding& binding) {
        return binding.port == task.activation.port;
      });
      if (read == task.reads.end()) {
        findings.at(task.line, path + ".activation.port", task.activation.port, "must be one of the ports the task reads");
        break;
      }
      const Duration period = shortest_period(cluster, *read);
      if (period > Duration{} && task.worst_case > period)
        findings.at(task.line, path + ".worst_case", ms(task.worst_case),
                    fmt::format("must be at most the shortest period of {}, {}", cluster.pdu(read->pdu).name, ms(period)));
      break;
    }
    case ActivationKind::kSensor:
      if (cluster.sensor(task.activation.sensor).device != id)
        findings.at(task.line, path + ".activation.sensor", cluster.sensor(task.activation.sensor).name,
                    fmt::format("must be a sensor whose device is {}", node.name));
      break;
    case ActivationKind::kCompletion: {
      // Followed to its beginning, a chain of completions must end at another kind of activation.
      const Task* at = &task;
      for (std::size_t steps = 0; at && at->activation.kind == ActivationKind::kCompletion; ++steps) {
        const auto before = std::find_if(node.tasks.begin(), node.tasks.end(), [&](const Task& candidate) {
          return candidate.name == at->activation.after;
        });
        if (before == node.tasks.end() || steps > node.tasks.size()) {
          findings.at(task.line, path + ".activation.after", task.activation.after,
                      "must lead back to a task of this node that time, a message or a sensor activates");
          break;
        }
        at = &*before;
      }
      break;
    }
  }
}

using Medium = std::pair<PduId, std::ptrdiff_t>;   // CAN index, -1 for FlexRay
Medium medium_of(const PortBinding& binding) {
  return {binding.pdu, binding.can_bus ? static_cast<std::ptrdiff_t>(*binding.can_bus) : -1};
}

struct End {
  NodeId node;
  const Task* task;
  const PortBinding* binding;
};

std::string end_path(const Cluster& cluster, const End& end, std::string_view direction) {
  return fmt::format("{}.{}.{}", task_path(cluster.node(end.node), *end.task), direction, end.binding->port);
}

std::string medium_name(const Cluster& cluster, const Medium& medium) {
  return fmt::format("{} on {}", cluster.pdu(medium.first).name,
                     medium.second < 0 ? "flexray" : cluster.can_buses[static_cast<std::size_t>(medium.second)].name);
}

// Who may send the list on its medium: the message's sender, or the owner of its slots.
std::optional<NodeId> sender_of(const Cluster& cluster, const Medium& medium) {
  if (medium.second >= 0) {
    for (const CanMessage& message : cluster.can_buses[static_cast<std::size_t>(medium.second)].messages)
      if (message.pdu == medium.first) return message.sender;
  } else {
    for (const FrameSlot& frame : cluster.frames)
      if (frame.pdu == medium.first) return frame.sender;
  }
  return std::nullopt;
}

void check_sensor(const Cluster& cluster, SensorId id, ClusterFindings& findings) {
  const Sensor& sensor = cluster.sensor(id);
  const std::string path = "sensors." + sensor.name;
  int measuring = 0;
  bool writes = false, host_reads = false;
  for (const Task& task : cluster.node(sensor.device).tasks) {
    if (task.activation.kind != ActivationKind::kSensor || task.activation.sensor != id) continue;
    ++measuring;
    for (const PortBinding& binding : task.writes) writes |= cluster.pdu(binding.pdu).sensor == id;
  }
  for (const Task& task : cluster.node(sensor.host).tasks)
    for (const PortBinding& binding : task.reads) host_reads |= cluster.pdu(binding.pdu).sensor == id;
  if (measuring != 1)
    findings.at(sensor.line, path + ".device", cluster.node(sensor.device).name,
                fmt::format("must have exactly one task that {} activates; it has {}", sensor.name, measuring));
  else if (!writes)
    findings.at(sensor.line, path + ".device", cluster.node(sensor.device).name,
                fmt::format("must write a PDU of the sensor {}", sensor.name));
  if (!host_reads)
    findings.at(sensor.line, path + ".host", cluster.node(sensor.host).name,
                fmt::format("must read a PDU of the sensor {}", sensor.name));
  if (!cluster.node(sensor.host).flexray)
    findings.at(sensor.line, path + ".host", cluster.node(sensor.host).name,
                "must be on FlexRay: it stamps the measurements with global time");
}

}  // namespace

void check_tasks(const Cluster& cluster, ClusterFindings& findings) {
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    const Node& node = cluster.nodes[n];
    for (std::size_t t = 0; t < node.tasks.size(); ++t) {
      const Task& task = node.tasks[t];
      const std::string path = task_path(node, task);
      if (task.worst_case > task.deadline)
        findings.at(task.line, path + ".worst_case", ms(task.worst_case),
                    fmt::format("must be at most the deadline, {}", ms(task.deadline)));
      check_activation(cluster, static_cast<NodeId>(n), task, findings);
      std::set<std::string> ports;
      for (const auto* bindings : {&task.reads, &task.writes})
        for (const PortBinding& binding : *bindings)
          if (!ports.insert(binding.port).second)
            findings.at(binding.line, path, binding.port, "is a port bound twice");
      if (task.activation.kind != ActivationKind::kTime) continue;
      for (std::size_t other = 0; other < t; ++other)
        if (node.tasks[other].activation.kind == ActivationKind::kTime &&
            meet(cluster.flexray, node.tasks[other], task))
          findings.at(task.line, path + ".activation", task.name,
                      fmt::format("overlaps {} of the same node (line {})", node.tasks[other].name,
                                  node.tasks[other].line));
    }
  }
}

void check_flow(const Cluster& cluster, ClusterFindings& findings) {
  std::map<Medium, std::vector<End>> writers, readers;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
    for (const Task& task : cluster.nodes[n].tasks) {
      for (const PortBinding& b : task.reads) readers[medium_of(b)].push_back({static_cast<NodeId>(n), &task, &b});
      for (const PortBinding& b : task.writes) writers[medium_of(b)].push_back({static_cast<NodeId>(n), &task, &b});
    }
  for (const auto& [medium, ends] : readers)
    for (const End& end : ends) {
      const std::string name = medium_name(cluster, medium);
      if (!writers.contains(medium))
        findings.at(end.binding->line, end_path(cluster, end, "reads"), name, "is read, but no task writes it");
      else if (sender_of(cluster, medium) == end.node)
        findings.at(end.binding->line, end_path(cluster, end, "reads"), name,
                    "is sent by the same node: a controller does not hear itself");
      if (medium.second < 0 && !cluster.node(end.node).flexray)
        findings.at(end.binding->line, end_path(cluster, end, "reads"), name, "needs a node on FlexRay");
    }
  for (const auto& [medium, ends] : writers) {
    const std::string name = medium_name(cluster, medium);
    if (!readers.contains(medium))
      findings.at(ends[0].binding->line, end_path(cluster, ends[0], "writes"), name, "is written, but no task reads it");
    if (ends.size() > 1)
      findings.at(ends[1].binding->line, end_path(cluster, ends[1], "writes"), name,
                  fmt::format("has a writer already: {}", end_path(cluster, ends[0], "writes")));
    const auto sender = sender_of(cluster, medium);
    if (!sender || *sender != ends[0].node)
      findings.at(ends[0].binding->line, end_path(cluster, ends[0], "writes"), name,
                  medium.second < 0 ? fmt::format("must have slots that {} owns", cluster.node(ends[0].node).name)
                                    : fmt::format("must be a message that {} sends", cluster.node(ends[0].node).name));
  }
  std::set<Medium> sent;
  for (const FrameSlot& frame : cluster.frames)
    if (frame.pdu != kNoPdu && sent.insert({frame.pdu, -1}).second && !writers.contains({frame.pdu, -1}))
      findings.at(frame.line, fmt::format("frames.slot {}", frame.slot), cluster.pdu(frame.pdu).name,
                  "has slots, but no task writes it");
  for (std::size_t b = 0; b < cluster.can_buses.size(); ++b)
    for (const CanMessage& message : cluster.can_buses[b].messages)
      if (!writers.contains({message.pdu, static_cast<std::ptrdiff_t>(b)}))
        findings.at(message.line, fmt::format("can.{}.messages.{}", cluster.can_buses[b].name,
                                              cluster.pdu(message.pdu).name), "", "is a message, but no task writes it");
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s) check_sensor(cluster, static_cast<SensorId>(s), findings);
}

}  // namespace ttf::schedules
