#include "sim/drives/step_catalog.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/check.h"
#include "core/errors.h"
#include "nodes/foreign/foreign_step.h"
#include "nodes/fusion/fusion_host.h"
#include "sim/drives/detectors.h"

namespace ttf::sim::drives {
namespace {

using schedules::model::Cluster;
using schedules::model::Node;
using schedules::model::Task;

std::array<std::span<const StepRow>, 3> tables() { return {sensor_steps(), fusion_steps(), driving_steps()}; }

// Returns whether the task's step uses the image, and so may read odometry beside it.
bool uses_image(const Task& task) {
  const StepRow* const row = find_step(task.step);
  return row != nullptr && row->ports.reads.contains("image");
}

}  // namespace

const StepRow* find_step(std::string_view name) {
  for (const std::span<const StepRow> table : tables())
    for (const StepRow& row : table)
      if (row.ports.step == name) return &row;
  return nullptr;
}

std::vector<schedules::model::StepPorts> step_ports() {
  std::vector<schedules::model::StepPorts> ports;
  for (const std::span<const StepRow> table : tables())
    for (const StepRow& row : table) ports.push_back(row.ports);
  return ports;
}

bool has_role(const Task& task, StepRole role) {
  const StepRow* const row = find_step(task.step);
  return row != nullptr && row->role == role;
}
bool has_role(const Node& node, StepRole role) {
  return std::ranges::any_of(node.tasks, [&](const Task& task) { return has_role(task, role); });
}
bool has_role(const Cluster& cluster, StepRole role) {
  return std::ranges::any_of(cluster.nodes, [&](const Node& node) { return has_role(node, role); });
}

std::string PlacedTask::path() const { return fmt::format("nodes.{}.tasks.{}", node->name, task->name); }

std::vector<PlacedTask> tasks_with(const Cluster& cluster, StepRole role) {
  std::vector<PlacedTask> found;
  for (const Node& node : cluster.nodes)
    for (const Task& task : node.tasks)
      if (has_role(task, role)) found.push_back({&node, &task});
  return found;
}

void check_steps(const Cluster& cluster) {
  schedules::model::bind_ports(cluster, step_ports());
  const SensorId odometry = nodes::fusion::fused_odometry(cluster);
  Findings findings;
  check_detectors(cluster, findings);
  for (const Node& node : cluster.nodes) {
    const Task* fusion = nullptr;
    bool reads = false;
    for (const Task& task : node.tasks) {
      if (has_role(task, StepRole::kFusion)) {
        if (fusion == nullptr) fusion = &task;
        reads = reads || nodes::fusion::odometry_of(cluster, task) != kNoSensor;
      }
      if (!uses_image(task) || odometry != kNoSensor) continue;
      for (const schedules::model::PortBinding& binding : task.reads)
        if (binding.port == "odometry")
          findings.add(cluster.finding(
              binding.line, fmt::format("nodes.{}.tasks.{}.reads.odometry", node.name, task.name),
              cluster.pdu(binding.pdu).name,
              "must be read by the fusion, too: without odometry there, the image's velocities are relative "
              "to the vehicle already"));
    }
    if (fusion != nullptr && !reads && odometry != kNoSensor)
      findings.add(cluster.finding(
          fusion->line, fmt::format("nodes.{}.tasks.{}.reads", node.name, fusion->name), "",
          fmt::format("must have {}, as another node's fusion has: all place their lists by it, or none does",
                      cluster.sensor(odometry).name)));
  }
  findings.throw_if_any();
}

void check_tasks(const Scenario& scenario, const Cluster& cluster) {
  Findings findings;
  for (const Node& node : cluster.nodes)
    for (const Task& task : node.tasks)
      if (const StepRow* const row = find_step(task.step); row != nullptr && row->check != nullptr)
        row->check(scenario, cluster, node, task, findings);
  findings.throw_if_any();
}

std::vector<std::shared_ptr<nodes::host::Step>> make_steps(const NodeSetConfig& config, NodeId id) {
  const Node& node = config.cluster->node(id);
  std::shared_ptr<nodes::fusion::FusionHost> fusion_host;
  std::vector<std::shared_ptr<nodes::host::Step>> steps;
  for (const Task& task : node.tasks) {
    if (const StepRow* const row = find_step(task.step)) {
      steps.push_back(row->make({config, node, task, fusion_host}));
      continue;
    }
    TTF_CHECK(schedules::model::names_library(task.step),
              "step {} of {} is not in the catalog; names are checked before", task.step, node.name);
    steps.push_back(std::make_shared<nodes::foreign::ForeignStep>(*config.cluster, node, task, config.steps));
  }
  return steps;
}

}  // namespace ttf::sim::drives
