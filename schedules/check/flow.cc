// The checker's rules about the sources and destinations of lists.
#include <fmt/format.h>

#include <compare>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "schedules/check/checker.h"

namespace ttf::schedules::check {
namespace {

// The lists of one PDU on one medium.
struct Flow {
  PduId pdu{};
  model::MediumId medium;
  auto operator<=>(const Flow&) const = default;
};
Flow flow_of(const model::PortBinding& binding) { return {binding.pdu, binding.medium}; }

struct End {
  NodeId node;
  const model::Task* task;
  const model::PortBinding* binding;
};

std::string end_path(const model::Cluster& cluster, const End& end, std::string_view direction) {
  return fmt::format("{}.{}.{}", task_path(cluster.node(end.node), *end.task), direction, end.binding->port);
}

std::string flow_name(const model::Cluster& cluster, const Flow& flow) {
  return fmt::format("{} on {}", cluster.pdu(flow.pdu).name,
                     flow.medium.is_can() ? cluster.can(flow.medium).name : "flexray");
}

// Returns the node that may send the list on its medium: the message's sender, or the owner of its slots.
std::optional<NodeId> sender_of(const model::Cluster& cluster, const Flow& flow) {
  if (flow.medium.is_can()) {
    for (const model::CanMessage& message : cluster.can(flow.medium).messages)
      if (message.pdu == flow.pdu) return message.sender;
  } else {
    for (const model::FrameSlot& frame : cluster.frames)
      if (frame.pdu == flow.pdu) return frame.sender;
  }
  return std::nullopt;
}

// Checks that a reader on FlexRay is attached to a channel of every frame of the list.
void check_receives(const model::Cluster& cluster, const End& end, const std::string& name, ClusterFindings& findings) {
  const model::Node& node = cluster.node(end.node);
  if (!node.flexray)
    return findings.at(end.binding->line, end_path(cluster, end, "reads"), name, "needs a node on FlexRay");
  for (const model::FrameSlot& frame : cluster.frames) {
    if (frame.pdu != end.binding->pdu || share_a_channel(frame.channels, node.flexray->pChannels)) continue;
    return findings.at(
        end.binding->line, end_path(cluster, end, "reads"), name,
        fmt::format("must be sent on {}: {} is attached to no other channel (pChannels), and slot {} ({}) "
                    "is on {} only",
                    channels_text(node.flexray->pChannels), node.name, frame.slot, place_text(cluster, frame.line),
                    channels_text(frame.channels)));
  }
}

void check_sensor(const model::Cluster& cluster, SensorId id, ClusterFindings& findings) {
  const model::Sensor& sensor = cluster.sensor(id);
  const std::string path = "sensors." + sensor.name;
  int measuring = 0;
  bool writes = false, host_reads = false;
  for (const model::Task& task : cluster.node(sensor.device).tasks) {
    if (task.activation.kind != model::ActivationKind::kSensor || task.activation.sensor != id) continue;
    ++measuring;
    for (const model::PortBinding& binding : task.writes) writes |= cluster.pdu(binding.pdu).sensor == id;
  }
  for (const model::Task& task : cluster.node(sensor.host).tasks)
    for (const model::PortBinding& binding : task.reads) host_reads |= cluster.pdu(binding.pdu).sensor == id;
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

// Checks that a sensor's lists never return to a task that they passed.
class RingFinder {
 public:
  RingFinder(const model::Cluster& cluster, const std::map<Flow, std::vector<End>>& readers, SensorId sensor,
             ClusterFindings& findings)
      : cluster_(cluster), readers_(readers), sensor_(sensor), findings_(findings) {
    for (const model::Node& node : cluster.nodes) state_.emplace_back(node.tasks.size(), State::kNew);
  }

  void run() {
    for (std::size_t n = 0; n < state_.size(); ++n)
      for (const model::Task& task : cluster_.nodes[n].tasks) visit(static_cast<NodeId>(n), task);
  }

 private:
  enum class State : std::uint8_t { kNew, kOnTheWay, kDone };

  State& state(NodeId node, const model::Task& task) {
    return state_[index_of(node)][static_cast<std::size_t>(&task - cluster_.node(node).tasks.data())];
  }

  void visit(NodeId node, const model::Task& task) {
    if (state(node, task) != State::kNew) return;
    state(node, task) = State::kOnTheWay;
    for (const model::PortBinding& binding : task.writes) {
      const auto ends = readers_.find(flow_of(binding));
      if (cluster_.pdu(binding.pdu).sensor != sensor_ || ends == readers_.end()) continue;
      for (const End& end : ends->second) {
        if (state(end.node, *end.task) == State::kOnTheWay)
          findings_.at(binding.line, end_path(cluster_, {node, &task, &binding}, "writes"),
                       flow_name(cluster_, ends->first),
                       fmt::format("leads back to {}: the way of a sensor's lists must not form a ring",
                                   task_path(cluster_.node(end.node), *end.task)));
        visit(end.node, *end.task);
      }
    }
    state(node, task) = State::kDone;
  }

  const model::Cluster& cluster_;
  const std::map<Flow, std::vector<End>>& readers_;
  SensorId sensor_;
  ClusterFindings& findings_;
  std::vector<std::vector<State>> state_;  // by node and task
};

}  // namespace

void check_flow(const model::Cluster& cluster, ClusterFindings& findings) {
  std::map<Flow, std::vector<End>> writers, readers;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
    for (const model::Task& task : cluster.nodes[n].tasks) {
      for (const model::PortBinding& b : task.reads) readers[flow_of(b)].push_back({static_cast<NodeId>(n), &task, &b});
      for (const model::PortBinding& b : task.writes)
        writers[flow_of(b)].push_back({static_cast<NodeId>(n), &task, &b});
    }
  for (const auto& [flow, ends] : readers)
    for (const End& end : ends) {
      const std::string name = flow_name(cluster, flow);
      if (!writers.contains(flow))
        findings.at(end.binding->line, end_path(cluster, end, "reads"), name, "is read, but no task writes it");
      else if (sender_of(cluster, flow) == end.node)
        findings.at(end.binding->line, end_path(cluster, end, "reads"), name,
                    "is sent by the same node: a controller does not hear itself");
      if (flow.medium.is_flexray()) check_receives(cluster, end, name, findings);
    }
  for (const auto& [flow, ends] : writers) {
    const std::string name = flow_name(cluster, flow);
    if (!readers.contains(flow))
      findings.at(ends[0].binding->line, end_path(cluster, ends[0], "writes"), name,
                  "is written, but no task reads it");
    if (ends.size() > 1)
      findings.at(ends[1].binding->line, end_path(cluster, ends[1], "writes"), name,
                  fmt::format("has a writer already: {}", end_path(cluster, ends[0], "writes")));
    const auto sender = sender_of(cluster, flow);
    if (!sender || *sender != ends[0].node)
      findings.at(ends[0].binding->line, end_path(cluster, ends[0], "writes"), name,
                  flow.medium.is_flexray()
                      ? fmt::format("must have slots that {} owns", cluster.node(ends[0].node).name)
                      : fmt::format("must be a message that {} sends", cluster.node(ends[0].node).name));
  }
  std::set<Flow> sent;
  for (const model::FrameSlot& frame : cluster.frames)
    if (frame.pdu != kNoPdu && sent.insert({frame.pdu, model::kFlexRay}).second &&
        !writers.contains({frame.pdu, model::kFlexRay}))
      findings.at(frame.line, frame_path(frame), cluster.pdu(frame.pdu).name, "has slots, but no task writes it");
  for (std::size_t b = 0; b < cluster.can_buses.size(); ++b)
    for (const model::CanMessage& message : cluster.can_buses[b].messages)
      if (!writers.contains({message.pdu, model::MediumId::can(b)}))
        findings.at(message.line, message_path(cluster.can_buses[b], message), cluster.pdu(message.pdu).name,
                    "is a message, but no task writes it");
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s) {
    check_sensor(cluster, static_cast<SensorId>(s), findings);
    RingFinder(cluster, readers, static_cast<SensorId>(s), findings).run();
  }
}

}  // namespace ttf::schedules::check
