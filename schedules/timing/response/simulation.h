// Exact responses of strictly periodic tasks with known offsets: preemptive fixed priorities, neither jitter nor
// blocking.
//
// The arrivals before the largest offset are a part of the periodic pattern, so the pattern without a beginning is
// the worst case. With offsets reduced below their periods, its backlog repeats from the end of the first hyperperiod
// on, if the load is at most one (J. Leung, M. Merrill, Information Processing Letters 11(3), 1980). A preemptive job
// ends no later if others take less time. So the jobs of the second hyperperiod, each with its worst case, show the
// longest responses.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "schedules/timing/response/fixed_priority.h"

namespace ttf::schedules::timing::response {

inline constexpr std::int64_t kMostSimulatedJobs = 2'000'000;

// Returns the longest response of each task, by priority, the highest first. Every task must have an offset. Returns
// nullopt if the load exceeds one, or if two hyperperiods have more than kMostSimulatedJobs jobs.
std::optional<std::vector<std::int64_t>> simulated_responses(std::span<const Task> by_priority);

}  // namespace ttf::schedules::timing::response
