// Longest responses of tasks with fixed priorities on one processor.
//
// A task arrives at least T apart and is released up to J after its arrival. It works for at most C. Priorities differ.
// Instance q of the task, counted from the start of the longest busy period of its priority, ends at
//
//   preemptive      F(q) = B + (q + 1) C + sum_hp ceil((F(q) + J_j) / T_j) C_j
//   non-preemptive  F(q) = w + C,  w = B + q C + sum_hp (floor((w + J_j) / T_j) + 1) C_j,  B = max_lp (C_j - 1)
//
// and its response is F(q) + J - q T. The analysis takes the largest value over all instances of the busy period, so
// deadlines may be longer than periods. Sources: M. Joseph, P. Pandya, Computer Journal 29(5), 1986; N. Audsley, A.
// Burns, M. Richardson, K. Tindell, A. Wellings, Software Engineering Journal 8(5), 1993; J. Lehoczky, RTSS 1990
// (busy period); L. George, N. Rivierre, M. Spuri, INRIA RR-2966, 1996 (non-preemptive).
//
// At full load (sum C / T = 1) a busy period may have no end. F(q + H / T) = F(q) + H for the hyperperiod H, so the
// instances of one hyperperiod are enough. Where a busy period has too many instances to look at, a closed form
// bounds the response:
//   F + J - q T <= J + (B + C + sum_hp C_j (1 + J_j / T_j)) / (1 - sum_hp C_j / T_j)      for sum_hep C_j / T_j <= 1
// (E. Bini, T. Nguyen, P. Richard, S. Baruah, IEEE Trans. Computers 58(2), 2009, with a simpler numerator).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "schedules/timing/response/response.h"

namespace ttf::schedules::timing::response {

// All times are in one unit; response.h has their range.
struct TaskTimes {
  std::int64_t period = 0;             // T, at least 1: the least time between two arrivals
  std::int64_t work = 0;               // C, at least 1: worst case
  std::int64_t deadline = 0;           // D, after the arrival; may exceed T. Only priorities.h reads it
  std::int64_t jitter = 0;             // J, from an arrival to its release
  std::int64_t blocking = 0;           // B, by lower priorities; preemptive only
  std::optional<std::int64_t> offset;  // at least 0: first arrival of a strictly periodic task; nullopt: any phase
};

// Each function takes tasks by priority, the highest first, and returns the responses in the same order.
//
// preemptive() is exact if no task of the same or a higher priority has an offset and B is zero. It is exact as well
// if all of them have offsets, neither jitter nor blocking, and at most kMostSimulatedJobs jobs in two hyperperiods
// (simulation.h), and for a task with an offset and no more jitter than its period, below any others, where the
// hyperperiod has not too many jobs (offsets.h). Otherwise it is a bound.
std::vector<Response> preemptive(std::span<const TaskTimes> by_priority);

// Exact if no task has an offset; a bound otherwise. Ignores TaskTimes::blocking, since lower priorities give it.
std::vector<Response> non_preemptive(std::span<const TaskTimes> by_priority);

// The same for one task, given the tasks of higher priority in any order, and the longest work of a lower priority
// (0: none).
Response preemptive_response(std::span<const TaskTimes> higher, const TaskTimes& task);
Response non_preemptive_response(std::span<const TaskTimes> higher, const TaskTimes& task, std::int64_t longest_lower);

}  // namespace ttf::schedules::timing::response
