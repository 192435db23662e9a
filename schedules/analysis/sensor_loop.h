// A sensor that follows its host: it measures each time the host has preprocessed its last measurement.
//
//   device:  measuring ==> raw list =(CAN)=> host:  after =====> trigger -> device, not before `period` is over
//
// A loop consists of the device's measuring task and the task `after` on the host. The raw list activates
// `after`, and no other task follows it. The host triggers at the end of `after` unless a newer list already
// waits for it, so that one list is in the loop. Two measurements are then at least
//   best(measuring) + shortest transfer + best(after)
// apart, however fast the device is. The host's task never meets its own next activation, which is the shortest
// transfer and measuring away from its end. The loop at its slowest must not exceed `longest`, or the device
// would measure by itself without any loss.
#pragma once

#include <optional>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

struct SensorLoop {
  SensorId sensor{};
  const model::Task* measuring = nullptr;   // the device's
  const model::PortBinding* raw = nullptr;  // written by `measuring` and read by `after`
  const model::Task* after = nullptr;       // the host's
};

// Returns nullopt for a sensor that does not follow, or with a loop that is not closed; check_loops() reports
// the latter.
std::optional<SensorLoop> loop_of(const model::Cluster& cluster, SensorId sensor);
// Returns the loop that activates this task of the node, if any.
std::optional<SensorLoop> loop_through(const model::Cluster& cluster, NodeId node, const model::Task& task);

// Returns a task's shortest execution time. Those of a task with modes last as its modes say.
inline Duration shortest_execution(const model::Task& task) {
  return task.draw == model::ExecutionDraw::kWorst && task.modes.empty() ? task.worst_case : task.best_case;
}

// Returns the shortest time from the end of `after` to its next activation, on any clock.
Duration shortest_return(const model::Cluster& cluster, const SensorLoop& loop);
// Return the time between two measurements on any clock: the shortest without `period`, and the longest with
// everything included. The latter is nullopt if nodes or media may be busy without end.
Duration shortest_round(const model::Cluster& cluster, const SensorLoop& loop);
std::optional<Duration> longest_round(const model::Cluster& cluster, const SensorLoop& loop);

}  // namespace ttf::schedules::analysis
