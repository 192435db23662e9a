// How long a node's tasks take at worst from their activation to their end, other tasks' turns included, and how soon
// they may be activated again.
//
// One processor per node, no preemption, first come first served: schedules/analysis/processor/busy_period.h bounds the
// first tasks of chains, each with all that follows it. A task that follows another starts its own account when that
// one ends. What may then be before it was activated since the other's activation; of every task at most one activation
// is pending, which is what the checker demands of all (an end before the next activation) and what makes these bounds
// hold one after the other. Durations are the node's own time, in which executions and deadlines are counted.
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
  // Shortest between two activations; nothing where nothing is known of them, or where the next waits for the task's
  // end.
  std::optional<Duration> gap;
  std::optional<Duration> written;  // shortest between two ends
};

// By task, in file order; nothing for a node that may be busy without end, or whose chains lead back to no beginning.
// No two tasks that time activates may overlap, as the checker demands first.
std::optional<std::vector<TaskResponse>> worst_responses(const model::Cluster& cluster, NodeId node,
                                                         WritersOfLists writers = WritersOfLists::kKnown);

// The same of one task, where of some others more is known: `ahead`, by task, is how long before this task's activation
// the newest activation of the other was at the latest (zero: nothing is known). For a task that messages activate.
std::optional<Duration> worst_response(const model::Cluster& cluster, NodeId node, std::size_t task,
                                       std::span<const Duration> ahead);

// The longest time a node may be busy without a break that worst_responses() looks into.
Duration longest_busy_time(const model::Cluster& cluster, const model::Node& node);

}  // namespace ttf::schedules::analysis
