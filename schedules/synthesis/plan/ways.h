// The way of a sensor's lists from task to task, up to a task that a chain names.
#pragma once

#include <cstddef>
#include <vector>

#include "core/ids.h"
#include "schedules/left_out/tasks.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::synthesis::plan {

using left_out::by_time;
using left_out::fuses;
using left_out::task_at;
using left_out::TaskId;

// The task, and the list by which the data comes to it. No list leads from a task that fuses to the one of its node that
// writes the image, nor to the first task.
struct Hop {
  TaskId at;
  const model::PortBinding* list = nullptr;  // as its writer binds it
};

// Returns the hops from the sensor's measuring task to `to`, both included: the first way in the order of tasks and lists.
// Returns none if no list leads there. The bindings are the cluster's.
std::vector<Hop> way_to(const model::Cluster& cluster, SensorId sensor, TaskId to);

// Returns the first task that begins by time at the end of the sensor's way: the reader of the image, or else the task that
// fuses; none if neither begins by time.
std::vector<Hop> way_to_use(const model::Cluster& cluster, SensorId sensor);

// Returns the channels, A and B, that lead from the list's sender to all its readers.
std::vector<model::Channels> channels_to_readers(const model::Cluster& cluster, NodeId sender, PduId pdu);

}  // namespace ttf::schedules::synthesis::plan
