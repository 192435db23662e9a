// The chains of a task set, and which task activates which.
#pragma once

#include <vector>

#include "core/errors.h"
#include "schedules/timing/task_set/fields.h"
#include "schedules/timing/task_set/task_set.h"

namespace ttf::schedules::timing::task_set {

// Adds the chains of the lines to a set whose tasks are complete. `task_lines` are the lines of its tasks. Sets
// Task::activator of event-driven tasks: the stage before them, the same in all chains. Mistakes go to
// the findings that the lines have.
void add_chains(TaskSet& set, std::vector<Fields>& chain_lines, std::vector<Fields>& task_lines, Findings& findings);

}  // namespace ttf::schedules::timing::task_set
