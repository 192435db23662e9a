// Tests of a processor's load: sufficient for rate monotonic priorities, independent tasks, deadlines equal to periods.
//
//   Liu and Layland   sum U_i <= n (2^(1/n) - 1)    C. Liu, J. Layland, Journal of the ACM 20(1), 1973, theorem 5
//   hyperbolic        prod (U_i + 1) <= 2           E. Bini, G. Buttazzo, IEEE Trans. Computers 52(7), 2003, theorem 1
//
// A set that passes meets all deadlines. A set that fails may meet them all the same: then fixed_priority.h decides.
// The hyperbolic test passes every set that Liu and Layland's passes.
#pragma once

#include <cstddef>
#include <span>

#include "schedules/timing/response/fixed_priority.h"

namespace ttf::schedules::timing::response {

// Returns the sum of C / T, for people: decisions compare whole numbers.
double utilisation(std::span<const TaskTimes> tasks);

// Returns n (2^(1/n) - 1): 1 for one task, falling to ln 2 = 0.6931. `tasks` is at least 1.
double liu_layland_bound(std::size_t tasks);

// Return whether a set passes. Both return false if a task has jitter, blocking or a deadline shorter than its
// period. A set within 1e-12 of the limit fails, unless whole numbers of 128 bits decide it.
bool passes_liu_layland(std::span<const TaskTimes> tasks);
bool passes_hyperbolic(std::span<const TaskTimes> tasks);

}  // namespace ttf::schedules::timing::response
