// The checker's rules about waiting. Every task ends by its deadline and before its next activation. Lists are
// sent no more often than their CAN messages declare.
#include <fmt/format.h>

#include <algorithm>

#include "core/int128.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/responses.h"
#include "schedules/check/checker.h"

namespace ttf::schedules::check {
namespace {

void check_task(const model::Node& node, const model::Task& task, const analysis::TaskResponse& response,
                ClusterFindings& findings) {
  const std::string path = task_path(node, task);
  if (response.worst > task.deadline)
    findings.parameter(
        path + ".deadline", ms(task.deadline),
        fmt::format("must be at least {}: the longest time from activation to end, with all waiting for other tasks",
                    ms(response.worst)));
  if (response.gap && response.worst >= *response.gap)
    findings.parameter(path + ".worst_case", ms(task.worst_case),
                       fmt::format("must let the task end before its next activation: it may end {} after its "
                                   "activation, and the next may follow {} after it",
                                   ms(response.worst), ms(*response.gap)));
}

// Compares in true time: the node's clock may be slow.
void check_written(const model::Cluster& cluster, const model::Node& node, const model::Task& task, Duration written,
                   ClusterFindings& findings) {
  const Duration shortest{static_cast<std::int64_t>(static_cast<Int128>(written.ns) *
                                                    (1'000'000'000 - analysis::worst_drift_ppb(node)) / 1'000'000'000)};
  for (const model::PortBinding& binding : task.writes) {
    if (binding.medium.is_flexray()) continue;
    const model::CanBus& bus = cluster.can(binding.medium);
    for (const model::CanMessage& message : bus.messages)
      if (message.pdu == binding.pdu && message.shortest_period > shortest)
        findings.at(message.line, message_path(bus, message) + ".shortest_period", ms(message.shortest_period),
                    fmt::format("must be at most {}: the shortest time between two lists of {}", ms(shortest),
                                task_path(node, task)));
  }
}

}  // namespace

void check_responses(const model::Cluster& cluster, NodeId id, ClusterFindings& findings) {
  const model::Node& node = cluster.node(id);
  const auto responses = analysis::worst_responses(cluster, id);
  if (!responses) {
    findings.at(
        node.line, fmt::format("nodes.{}.tasks", node.name), "",
        fmt::format("must leave the node idle at least once in {}: its tasks may need more than all of its time",
                    ms(analysis::longest_busy_time(cluster, node))));
    return;
  }
  for (std::size_t t = 0; t < node.tasks.size(); ++t) {
    const analysis::TaskResponse& response = (*responses)[t];
    check_task(node, node.tasks[t], response, findings);
    if (response.written) check_written(cluster, node, node.tasks[t], *response.written, findings);
  }
}

}  // namespace ttf::schedules::check
