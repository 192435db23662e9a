// The tasks of a cluster by node and number, and their lists.
#pragma once

#include <compare>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::left_out {

struct TaskId {
  NodeId node{};
  std::size_t task = 0;  // within the node
  auto operator<=>(const TaskId&) const = default;
};

const model::Task& task_at(const model::Cluster& cluster, TaskId id);
bool by_time(const model::Task& task);

// Returns whether the task fuses: it reads sensors' lists alone and writes none, and another task of its node writes the image.
bool fuses(const model::Cluster& cluster, TaskId id);

// Returns whether the task writes a list of no single sensor, as the image is.
bool writes_image(const model::Cluster& cluster, TaskId id);

// Returns the tasks that follow this one, each at the end of the one before it.
std::vector<TaskId> followers(const model::Cluster& cluster, TaskId id);

// Returns the first task that writes the list.
std::optional<TaskId> writer_of(const model::Cluster& cluster, PduId pdu, model::MediumId medium);

}  // namespace ttf::schedules::left_out
