// Longest responses on one resource, for given jitters.
//
// The analyses are those of schedules/timing/response. An answer is exact if the set has a case that reaches it. It is
// a bound at most
//   * where an activated task takes part: the activators' worst cases may never come together
//   * with known offsets on a CAN, whose analysis has none
//   * behind periodic messages of a dynamic segment: the search has them come later than their period, too
// With errors at random on a CAN no response has a bound. The answers then are those without errors, and
// miss_probabilities() says how much they are worth.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/time.h"
#include "schedules/timing/response/response.h"
#include "schedules/timing/task_set/task_set.h"

namespace ttf::schedules::timing::task_set {

// The tasks of a resource by priority, the highest first, and their jitters in this order.
struct PrioritisedTasks {
  std::size_t resource = 0;
  std::span<const std::size_t> tasks;
  std::span<const Duration> jitters;
};

// Returns the response of each task, in the order of priorities; the resource must not be a table.
std::vector<response::Response> resource_responses(const TaskSet& set, const PrioritisedTasks& on);

// Returns another order of priorities that meets all deadlines, by Audsley's algorithm. Tables, TDMA and dynamic
// segments have none.
std::optional<std::vector<std::size_t>> audsleys_order(const TaskSet& set, const PrioritisedTasks& on);

// Returns for each message of a CAN with errors at random the probability, at most, that it ends later than its
// deadline or its period (schedules/timing/response/can_faults.h); 1e-12 at least. Empty for other resources.
std::vector<double> miss_probabilities(const TaskSet& set, const PrioritisedTasks& on);

}  // namespace ttf::schedules::timing::task_set
