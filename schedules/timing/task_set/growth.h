// Jitters of activations that grow without end.
//
// A task that a activates has a jitter of R_a less a's shortest time. With higher priorities j, of loads U_j, and U
// their sum, R_a lies between two lines of the same slope:
//   J_a + (C_a + sum_j U_j J_j) / (1 - U)  <=  R_a  <=  J_a + (C_a + B + sum_j (C_j + U_j J_j)) / (1 - U)
// (fluid bounds; E. Bini, T. H. C. Nguyen, P. Richard, S. K. Baruah, IEEE Transactions on Computers 58(2), 2009). So
// jitters obey J >= A J + b, and the least solution is finite if, and only if, no cycle of dependences has a spectral
// radius of one or more. I - A then is an M-matrix: Gauss' elimination finds positive pivots alone (A. Berman, R.
// Plemmons: Nonnegative Matrices in the Mathematical Sciences, chapter 6). Where a pivot is not positive, its jitter
// has no end.
#pragma once

#include <cstddef>
#include <vector>

#include "schedules/timing/task_set/task_set.h"

namespace ttf::schedules::timing::task_set {

// Takes the tasks of each resource by priority. Returns the activated tasks, one or more of each cycle of dependences
// that has no solution, or is within 1e-9 of that. A dynamic segment counts without its lost cycles, so that cycles of
// dependences over one may have no solution all the same.
std::vector<std::size_t> endless_jitters(const TaskSet& set, const std::vector<std::vector<std::size_t>>& by_priority);

}  // namespace ttf::schedules::timing::task_set
