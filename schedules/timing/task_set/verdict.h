// Whether a task set keeps its deadlines and the largest ages of its chains.
#pragma once

#include <string>
#include <vector>

#include "schedules/timing/task_set/chain_times.h"
#include "schedules/timing/task_set/responses.h"
#include "schedules/timing/task_set/task_set.h"

namespace ttf::schedules::timing::task_set {

struct Verdict {
  Responses responses;
  std::vector<ChainTiming> chains;
  std::vector<std::string> misses;  // a sentence for each deadline or age that is not kept; empty: the set holds

  bool holds() const { return misses.empty(); }
};

Verdict verdict_on(const TaskSet& set);

// Returns the responses of each resource, and the chains with the share of each stage, as tables in milliseconds.
std::string verdict_text(const TaskSet& set, const Verdict& verdict);

}  // namespace ttf::schedules::timing::task_set
