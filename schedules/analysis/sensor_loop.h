// A sensor that follows its host: it measures whenever the host has preprocessed its last measurement.
//
//   device:  measuring ==> raw list =(CAN)=> host:  after =====> trigger -> device, not before `period` is over
//
// The ends of a loop are the device's measuring task and the task `after` that its raw list activates on the host, and
// that no other task follows; a host triggers where that task ends and no newer list waits for it already, so that
// there is one list in the loop. In it a measurement comes at least
//   best(measuring) + shortest transfer + best(after)
// after the one before, however fast the device could, and the host's task never meets its own next activation: that is
// the shortest transfer and measuring away from its end. The loop at its slowest must be no longer than `longest`, or
// the device would measure by itself though nothing is lost.
#pragma once

#include <optional>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

struct SensorLoop {
  SensorId sensor{};
  const model::Task* measuring = nullptr;   // of the device
  const model::PortBinding* raw = nullptr;  // what that writes and `after` reads
  const model::Task* after = nullptr;       // of the host
};

// Nothing for a sensor that does not follow, or whose loop is not closed, which check_loops() says.
std::optional<SensorLoop> loop_of(const model::Cluster& cluster, SensorId sensor);
// The loop that activates this task of the node, if one does.
std::optional<SensorLoop> loop_through(const model::Cluster& cluster, NodeId node, const model::Task& task);

// Of a task's execution times.
inline Duration shortest_execution(const model::Task& task) {
  return task.draw == model::ExecutionDraw::kWorst ? task.worst_case : task.best_case;
}

// From the end of `after` to its next activation at the least, on any clock.
Duration shortest_return(const model::Cluster& cluster, const SensorLoop& loop);
// From one measurement to the next at the least, on any clock, `period` left out; and at the most, all included:
// nothing where nodes or media may be busy without end.
Duration shortest_round(const model::Cluster& cluster, const SensorLoop& loop);
std::optional<Duration> longest_round(const model::Cluster& cluster, const SensorLoop& loop);

}  // namespace ttf::schedules::analysis
