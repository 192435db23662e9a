// Worst-case response times of a node's tasks, from activation to end, with all waiting for other tasks, and the
// shortest times between their activations.
//
// One processor per node, no preemption, first come first served. schedules/analysis/processor/busy_period.h
// bounds the first task of each chain, with all tasks that follow it. A following task is activated at the end
// of its predecessor; then tasks activated since the predecessor's activation may come before it. At most one
// activation of every task is pending: the checker demands an end before the next activation. These bounds
// therefore hold one after the other. Durations are in the node's own time, like executions and deadlines.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/analysis/activation_bounds.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

struct TaskResponse {
  Duration worst{};  // from activation to end
  // Shortest time between two activations; nullopt if it is unknown, or if the next activation waits for the
  // task's end.
  std::optional<Duration> gap;
  std::optional<Duration> written;  // shortest time between two ends
};

// Returns the responses by task, in file order; nullopt for a node that may be busy without end, or whose chains
// form a ring. Tasks activated by time must not overlap, which the checker demands first.
std::optional<std::vector<TaskResponse>> worst_responses(const model::Cluster& cluster, NodeId node,
                                                         WritersOfLists writers = WritersOfLists::kKnown);

// Returns the response of one task that messages activate, with leads of other tasks. `ahead`, by task, is the
// least time by which the newest activation of the other precedes this task's activation (zero: unknown).
std::optional<Duration> worst_response(const model::Cluster& cluster, NodeId node, std::size_t task,
                                       std::span<const Duration> ahead);

// Returns the shortest distance of two instants in global time that are at least `time` apart on the node's own clock, whatever
// its corrections: so far behind a task's instant another one's may lie without a wait.
Duration least_apart(const model::Cluster& cluster, const model::Node& node, Duration time);

// Returns the longest busy time without a break that worst_responses() considers.
Duration longest_busy_time(const model::Cluster& cluster, const model::Node& node);

}  // namespace ttf::schedules::analysis
