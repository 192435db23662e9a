#include "schedules/left_out/tasks.h"

#include <algorithm>

#include "schedules/analysis/age_stages.h"

namespace ttf::schedules::left_out {

const model::Task& task_at(const model::Cluster& cluster, TaskId id) { return cluster.node(id.node).tasks[id.task]; }

bool by_time(const model::Task& task) { return task.activation.kind == model::ActivationKind::kTime; }

bool fuses(const model::Cluster& cluster, TaskId id) {
  const model::Task& task = task_at(cluster, id);
  const bool of_sensors = std::all_of(task.reads.begin(), task.reads.end(),
                                      [&](const auto& in) { return cluster.pdu(in.pdu).sensor != kNoSensor; });
  return of_sensors && !task.reads.empty() && task.writes.empty() &&
         analysis::publisher_of(cluster, id.node).task != nullptr;
}

bool writes_image(const model::Cluster& cluster, TaskId id) {
  const model::Task& task = task_at(cluster, id);
  return std::any_of(task.writes.begin(), task.writes.end(),
                     [&](const auto& out) { return cluster.pdu(out.pdu).sensor == kNoSensor; });
}

std::vector<TaskId> followers(const model::Cluster& cluster, TaskId id) {
  const std::vector<model::Task>& tasks = cluster.node(id.node).tasks;
  std::vector<TaskId> found{id};
  for (std::size_t i = 0; i < found.size() && found.size() <= tasks.size(); ++i)
    for (std::size_t t = 0; t < tasks.size(); ++t)
      if (tasks[t].activation.kind == model::ActivationKind::kCompletion &&
          tasks[t].activation.after == tasks[found[i].task].name)
        found.push_back({id.node, t});
  found.erase(found.begin());
  return found;
}

std::optional<TaskId> writer_of(const model::Cluster& cluster, PduId pdu, model::MediumId medium) {
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
    for (std::size_t t = 0; t < cluster.nodes[n].tasks.size(); ++t)
      for (const model::PortBinding& out : cluster.nodes[n].tasks[t].writes)
        if (out.pdu == pdu && out.medium == medium) return TaskId{static_cast<NodeId>(n), t};
  return std::nullopt;
}

}  // namespace ttf::schedules::left_out
