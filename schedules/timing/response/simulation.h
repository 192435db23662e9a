// All jobs of strictly periodic tasks with known offsets: preemptive fixed priorities, neither jitter nor blocking.
//
// The arrivals before the largest offset are a part of the periodic pattern, so the pattern without a beginning is
// the worst case. With offsets reduced below their periods, its backlog repeats from the end of the first hyperperiod
// on, if the load is at most one (J. Leung, M. Merrill, Information Processing Letters 11(3), 1980). A preemptive job
// starts and ends no later if others take less time (R. Ha, J. Liu: "Validating timing constraints in multiprocessor
// and distributed real-time systems", ICDCS 1994). So the jobs of the second hyperperiod show all: each with its worst
// case the longest responses and the latest ends, each with its best case the earliest starts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "schedules/timing/response/fixed_priority.h"

namespace ttf::schedules::timing::response {

inline constexpr std::int64_t kMostSimulatedJobs = 2'000'000;

struct PeriodicWork {
  std::int64_t period = 1;
  std::int64_t offset = 0;
  std::int64_t work = 0;  // each job's; may be 0
};

// A job that is released in the second hyperperiod. Times count from the beginning of that hyperperiod.
struct EndedJob {
  std::size_t task = 0;
  std::int64_t release = 0;  // 0 to the hyperperiod, exclusive
  std::int64_t start = 0;
  std::int64_t end = 0;
};

// Returns the hyperperiod. Returns none if it exceeds `longest`, if the load exceeds one, or if two hyperperiods have
// more than `most_jobs` jobs.
std::optional<std::int64_t> simulated_hyperperiod(std::span<const PeriodicWork> tasks, std::int64_t longest,
                                                  std::int64_t most_jobs);

// Takes tasks by priority, the highest first, and their simulated_hyperperiod(). Calls `seen` for each job of the
// second hyperperiod as it ends. Later jobs may delay it.
void simulate_jobs(std::span<const PeriodicWork> by_priority, std::int64_t hyperperiod,
                   const std::function<void(const EndedJob&)>& seen);

// Returns the longest response of each task, by priority, the highest first. Every task must have an offset. Returns
// nullopt if simulated_hyperperiod() has none for kMostSimulatedJobs.
std::optional<std::vector<std::int64_t>> simulated_responses(std::span<const TaskTimes> by_priority);

}  // namespace ttf::schedules::timing::response
