// Longest responses with known offsets and jitter: preemptive fixed priorities without blocking.
//
// Job n of task j arrives at O_j + n T_j and is released within J_j. A busy period that begins at s and delays the job
// of task i that arrives at a ends at the least
//   f = s + sum_hp N_j(s, f) C_j + N_i(s, a + 1) C_i,    N_j(s, f) = ceil((f - O_j) / T_j) - ceil((s - J_j - O_j) / T_j)
// N_j counts the jobs that may be released from s on and arrive before f. All of them may: each at s, or as it arrives.
// So f - a is reached, and the longest one over all a and s is exact. Between two instants O_j + n T_j + J_j the jobs are
// the same and f grows with s, so that these instants are enough. They lie within the longest busy period. Tasks without
// an offset have any phase, and come at s after all of their jitter: N_j = ceil((f - s + J_j) / T_j).
//
// The candidates are those of J. Palencia, M. Gonzalez Harbour (RTSS 1998), with a hyperperiod in place of transactions
// that have any phase.
#pragma once

#include <optional>
#include <span>

#include "schedules/timing/response/fixed_priority.h"

namespace ttf::schedules::timing::response {

// Returns the longest response of a task with an offset, below `higher`; exact. Returns nullopt if it has none, has
// blocking or more jitter than its period, at full load, and where hyperperiod and busy period are too long.
std::optional<std::int64_t> response_with_offsets(std::span<const TaskTimes> higher, const TaskTimes& task);

}  // namespace ttf::schedules::timing::response
