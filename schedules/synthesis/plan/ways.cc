#include "schedules/synthesis/plan/ways.h"

#include <algorithm>
#include <functional>
#include <set>

namespace ttf::schedules::synthesis::plan {
namespace {

bool same_list(const model::PortBinding& out, const model::PortBinding& in) {
  return out.pdu == in.pdu && out.medium == in.medium;
}

class Walker {
 public:
  Walker(const model::Cluster& cluster, SensorId sensor) : cluster_(cluster), sensor_(sensor) {}

  std::vector<Hop> walk(const std::function<bool(TaskId)>& arrived) {
    const NodeId device = cluster_.sensor(sensor_).device;
    const std::vector<model::Task>& tasks = cluster_.node(device).tasks;
    for (std::size_t t = 0; t < tasks.size(); ++t)
      if (tasks[t].activation.kind == model::ActivationKind::kSensor && tasks[t].activation.sensor == sensor_ &&
          visit({{device, t}, nullptr}, arrived))
        return way_;
    return {};
  }

 private:
  bool visit(const Hop& hop, const std::function<bool(TaskId)>& arrived) {
    if (!seen_.insert(hop.at).second) return false;
    way_.push_back(hop);
    if (arrived(hop.at)) return true;
    const model::Task& task = task_at(cluster_, hop.at);
    for (const model::PortBinding& out : task.writes) {
      const SensorId of = cluster_.pdu(out.pdu).sensor;
      if (of != sensor_ && of != kNoSensor) continue;
      for (const TaskId& reader : readers(out))
        if (visit({reader, &out}, arrived)) return true;
    }
    if (fuses(cluster_, hop.at))
      for (const TaskId& publisher : publishers(hop.at.node))
        if (visit({publisher, nullptr}, arrived)) return true;
    way_.pop_back();
    return false;
  }

  std::vector<TaskId> readers(const model::PortBinding& out) const {
    std::vector<TaskId> found;
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      for (std::size_t t = 0; t < cluster_.nodes[n].tasks.size(); ++t)
        for (const model::PortBinding& in : cluster_.nodes[n].tasks[t].reads)
          if (same_list(out, in)) found.push_back({static_cast<NodeId>(n), t});
    return found;
  }

  std::vector<TaskId> publishers(NodeId node) const {
    std::vector<TaskId> found;
    const std::vector<model::Task>& tasks = cluster_.node(node).tasks;
    for (std::size_t t = 0; t < tasks.size(); ++t)
      if (left_out::writes_image(cluster_, {node, t})) found.push_back({node, t});
    return found;
  }

  const model::Cluster& cluster_;
  SensorId sensor_;
  std::set<TaskId> seen_;
  std::vector<Hop> way_;
};

}  // namespace

std::vector<Hop> way_to(const model::Cluster& cluster, SensorId sensor, TaskId to) {
  return Walker(cluster, sensor).walk([&](TaskId at) { return at == to; });
}

std::vector<Hop> way_to_use(const model::Cluster& cluster, SensorId sensor) {
  const auto used = Walker(cluster, sensor).walk([&](TaskId at) {
    const model::Task& task = task_at(cluster, at);
    return by_time(task) && std::any_of(task.reads.begin(), task.reads.end(), [&](const model::PortBinding& in) {
             return cluster.pdu(in.pdu).sensor == kNoSensor;
           });
  });
  if (!used.empty()) return used;
  return Walker(cluster, sensor).walk([&](TaskId at) { return by_time(task_at(cluster, at)) && fuses(cluster, at); });
}

std::vector<model::Channels> channels_to_readers(const model::Cluster& cluster, NodeId sender, PduId pdu) {
  const auto attached = [](const model::Node& node, model::Channels channel) {
    return node.flexray && share_a_channel(node.flexray->pChannels, channel);
  };
  std::vector<model::Channels> found;
  for (const model::Channels channel : {model::Channels::kA, model::Channels::kB}) {
    bool all = attached(cluster.node(sender), channel);
    for (const model::Node& node : cluster.nodes)
      for (const model::Task& task : node.tasks)
        for (const model::PortBinding& in : task.reads)
          all = all && (in.pdu != pdu || !in.medium.is_flexray() || attached(node, channel));
    if (all) found.push_back(channel);
  }
  return found;
}

}  // namespace ttf::schedules::synthesis::plan
