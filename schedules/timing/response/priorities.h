// Assignments of priorities.
//
// Rate monotonic: shorter periods first; optimal for deadlines equal to periods (Liu, Layland 1973). Deadline
// monotonic: shorter deadlines first; optimal for preemptive tasks with deadlines up to the period, without jitter
// (J. Leung, J. Whitehead, Performance Evaluation 2(4), 1982). Audsley's algorithm is optimal for each analysis in
// which a response depends on the set of higher priorities and the set of lower ones, but not on the order within
// each (N. Audsley, Information Processing Letters 79(1), 2001): preemptive and non-preemptive tasks with any
// deadlines, and CAN.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "schedules/timing/response/fixed_priority.h"

namespace ttf::schedules::timing::response {

// Places in the caller's list, the highest priority first.
using PriorityOrder = std::vector<std::size_t>;

// Tasks with the same period or deadline keep their order.
PriorityOrder rate_monotonic(std::span<const TaskTimes> tasks);
PriorityOrder deadline_monotonic(std::span<const TaskTimes> tasks);

// Returns whether a task meets its deadline below all of `higher` and above all of `lower`. Both are in ascending
// order.
using Fits =
    std::function<bool(std::size_t task, std::span<const std::size_t> higher, std::span<const std::size_t> lower)>;

// Returns an order in which every one of `count` tasks fits; nullopt if there is none. Asks at most count (count + 1)
// / 2 times. Where several fit, the last in the list gets the lower priority: a list in deadline monotonic order
// changes little.
std::optional<PriorityOrder> audsley(std::size_t count, const Fits& fits);

// Audsley's algorithm with preemptive_response() or non_preemptive_response().
std::optional<PriorityOrder> audsley_preemptive(std::span<const TaskTimes> tasks);
std::optional<PriorityOrder> audsley_non_preemptive(std::span<const TaskTimes> tasks);

// Returns the elements in an order: in_order(tasks, rate_monotonic(tasks)).
template <class T> std::vector<T> in_order(const std::vector<T>& list, const PriorityOrder& order) {
  std::vector<T> ordered;
  ordered.reserve(order.size());
  for (const std::size_t place : order) ordered.push_back(list[place]);
  return ordered;
}

}  // namespace ttf::schedules::timing::response
