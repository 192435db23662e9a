// Whether a task set keeps its deadlines and the largest ages of its chains.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "schedules/timing/chain/end_to_end.h"
#include "schedules/timing/task_set/responses.h"
#include "schedules/timing/task_set/task_set.h"

namespace ttf::schedules::timing::task_set {

// The times of a chain, with its tasks as stages of schedules/timing/chain:
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
struct ChainTiming {
  std::optional<chain::EndToEnd> times;
  std::string why_none;  // a sentence, where there are no times
};

// Returns whether the chain goes over a CAN with errors at random: its times then are those without errors.
bool ignores_errors(const TaskSet& set, const Chain& chain);

// Returns whether the data age is within the chain's limit, if it has one.
bool keeps_age(const Chain& chain, const ChainTiming& timing);

struct Verdict {
  Responses responses;
  std::vector<ChainTiming> chains;  // in the set's order
  std::vector<std::string> misses;  // a sentence for each deadline or age that is not kept; empty: the set holds

  bool holds() const { return misses.empty(); }
};

Verdict verdict_on(const TaskSet& set);

// Returns the responses of each resource, and the chains with the share of each stage, as tables in milliseconds.
std::string verdict_text(const TaskSet& set, const Verdict& verdict);

}  // namespace ttf::schedules::timing::task_set
