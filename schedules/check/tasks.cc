// The checker's rules about tasks: their activations and execution times.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "schedules/analysis/activation_bounds.h"
#include "schedules/analysis/sensor_loop.h"
#include "schedules/analysis/slot_groups.h"
#include "schedules/check/checker.h"

namespace ttf::schedules::check {
namespace {

// Returns whether two periodic intervals, each shorter than its period, overlap. Their starts differ by `from_a`
// modulo the common divisor of their periods, and some instances by no more (Chinese remainder theorem).
bool overlap(const model::GlobalParameters& flexray, const model::Task& a, const model::Task& b) {
  const model::CycleInstant &x = a.activation.at, &y = b.activation.at;
  const std::int64_t cycle_ns = flexray.cycle_ps() / 1000;
  const std::int64_t period = cycle_ns * std::gcd(x.repetition, y.repetition);
  const std::int64_t start_a = time_of(flexray, x.base_cycle, x.offset).ns;
  const std::int64_t start_b = time_of(flexray, y.base_cycle, y.offset).ns;
  const std::int64_t from_a = ((start_b - start_a) % period + period) % period;  // a's start to the next start of b
  return from_a < a.worst_case.ns || period - from_a < b.worst_case.ns;
}

// Returns the shortest time between two lists that activate the task, or zero if it is unknown. It counts their
// sendings, or their writings if these are rarer.
Duration shortest_period(const model::Cluster& cluster, const model::Task& task, const model::PortBinding& binding) {
  if (binding.medium.is_can()) {
    for (const model::CanMessage& message : cluster.can(binding.medium).messages)
      if (message.pdu == binding.pdu) return message.shortest_period;
    return {};
  }
  const auto slots = analysis::shortest_slot_gap(cluster, binding.pdu);
  if (!slots) return {};
  Duration shortest = slots->gap;
  for (const auto& one : activation_bounds(cluster, task, analysis::WritersOfLists::kKnown).all)
    shortest = std::max(shortest, Duration{one.period});
  return shortest;
}

void check_activation(const model::Cluster& cluster, NodeId id, const model::Task& task, ClusterFindings& findings) {
  const model::Node& node = cluster.node(id);
  const std::string path = task_path(node, task);
  switch (task.activation.kind) {
    case model::ActivationKind::kTime: {
      if (!node.flexray)
        findings.parameter(path + ".activation", "time", "needs a node on FlexRay: other nodes have no global time");
      const Duration period = cluster.cycle() * task.activation.at.repetition;
      if (task.deadline > period)
        findings.parameter(path + ".deadline", ms(task.deadline),
                           fmt::format("must be at most the task's period, {}", ms(period)));
      if (task.worst_case > period)
        findings.parameter(path + ".worst_case", ms(task.worst_case),
                           fmt::format("must be at most the task's period, {}: it overlaps itself", ms(period)));
      break;
    }
    case model::ActivationKind::kModes: {
      if (task.modes.empty())
        findings.parameter(path + ".activation", "modes", "needs the key modes, with at least one mode");
      if (!node.flexray)
        findings.parameter(path + ".activation", "modes", "needs a node on FlexRay: other nodes have no global time");
      if (node.tasks.size() != 1)
        findings.parameter(
            path + ".activation", "modes",
            fmt::format("must be that of the only task of {}: its executions last as its modes say", node.name));
      if (task.draw != model::ExecutionDraw::kWorst)
        findings.parameter(path + ".draw", "uniform", "must be worst: lists wait for the times of the task's modes");
      if (task.holds > Duration{})
        findings.parameter(path + ".holds", ms(task.holds),
                           "must be absent: a task with modes writes at the end of the execution that reads");
      break;
    }
    case model::ActivationKind::kMessage: {
      const auto read = std::find_if(task.reads.begin(), task.reads.end(),
                                     [&](const model::PortBinding& binding) { return activates(task, binding); });
      if (read == task.reads.end()) {
        findings.parameter(path + ".activation.port", task.activation.port, "must be one of the ports the task reads");
        break;
      }
      const Duration period = shortest_period(cluster, task, *read);
      // A sensor that waits for the task's end sends no list before it.
      const bool waited_for = analysis::loop_through(cluster, id, task).has_value();
      if (period > Duration{} && task.worst_case > period && !waited_for)
        findings.parameter(
            path + ".worst_case", ms(task.worst_case),
            fmt::format("must be at most the shortest period of {}, {}", cluster.pdu(read->pdu).name, ms(period)));
      break;
    }
    case model::ActivationKind::kSensor: {
      const model::Sensor& sensor = cluster.sensor(task.activation.sensor);
      if (task.worst_case > sensor.period)
        findings.parameter(
            path + ".worst_case", ms(task.worst_case),
            fmt::format("must be at most the period of the sensor {}, {}", sensor.name, ms(sensor.period)));
      if (sensor.device != id)
        findings.parameter(path + ".activation.sensor", sensor.name,
                           fmt::format("must be a sensor whose device is {}", node.name));
      break;
    }
    case model::ActivationKind::kCompletion: {
      // The first task of a chain of completions must have another kind of activation.
      const model::Task* at = &task;
      for (std::size_t steps = 0; at && at->activation.kind == model::ActivationKind::kCompletion; ++steps) {
        const auto before = std::find_if(node.tasks.begin(), node.tasks.end(), [&](const model::Task& candidate) {
          return candidate.name == at->activation.after;
        });
        if (before == node.tasks.end() || steps > node.tasks.size()) {
          findings.parameter(path + ".activation.after", task.activation.after,
                             "must lead back to a task of this node that time, a message or a sensor activates");
          break;
        }
        at = &*before;
      }
      break;
    }
  }
}

}  // namespace

void check_tasks(const model::Cluster& cluster, ClusterFindings& findings) {
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    const model::Node& node = cluster.nodes[n];
    const std::size_t before = findings.size();
    for (std::size_t t = 0; t < node.tasks.size(); ++t) {
      const model::Task& task = node.tasks[t];
      const std::string path = task_path(node, task);
      if (task.worst_case > task.deadline)
        findings.parameter(path + ".worst_case", ms(task.worst_case),
                           fmt::format("must be at most the deadline, {}", ms(task.deadline)));
      check_activation(cluster, static_cast<NodeId>(n), task, findings);
      std::set<std::string> ports;
      for (const auto* bindings : {&task.reads, &task.writes})
        for (const model::PortBinding& binding : *bindings)
          if (!ports.insert(binding.port).second)
            findings.at(binding.line, path, binding.port, "is a port bound twice");
      if (task.activation.kind != model::ActivationKind::kTime) continue;
      for (std::size_t other = 0; other < t; ++other)
        if (node.tasks[other].activation.kind == model::ActivationKind::kTime &&
            overlap(cluster.flexray, node.tasks[other], task))
          findings.parameter(path + ".activation", task.name,
                             fmt::format("overlaps {} of the same node ({})", node.tasks[other].name,
                                         place_text(cluster, node.tasks[other].line)));
    }
    if (findings.size() == before) check_responses(cluster, static_cast<NodeId>(n), findings);
  }
}

}  // namespace ttf::schedules::check
