// The chains of a task set as stages of schedules/timing/chain, and their times.
//
//   LET             reads at its release, writes at its deadline
//   table           reads at its offset, writes its worst case later; exact, for a job may take its best case or its
//                   worst whatever others do
//   implicit        reads at its start, which is not before its release, and writes within its response. On a
//                   preemptive processor whose tasks all have offsets and no jitter, all jobs of a hyperperiod are
//                   known: exact if best and worst cases are equal, bounds otherwise
//   message         takes its value at its release, as it is queued
//   activated       ends its response behind its earliest release, which its activator's shortest time precedes
//
// A resource with a single task that ends at once is exact, too. A periodic task without an offset has any phase against the others. A
// chain whose responses sum up to more than half of chain::kLongest has no times.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "schedules/timing/chain/end_to_end.h"
#include "schedules/timing/task_set/responses.h"
#include "schedules/timing/task_set/task_set.h"

namespace ttf::schedules::timing::task_set {

struct ChainTiming {
  std::optional<chain::EndToEnd> times;
  std::string why_none;  // a sentence, where there are no times
};

// Returns the times of the chains in the set's order.
std::vector<ChainTiming> chain_times(const TaskSet& set, const Responses& responses);

// Returns whether the chain goes over a CAN with errors at random: its times then are those without errors.
bool ignores_errors(const TaskSet& set, const Chain& chain);

// Returns whether the data age is within the chain's limit, if it has one.
bool meets_age(const Chain& chain, const ChainTiming& timing);

}  // namespace ttf::schedules::timing::task_set
