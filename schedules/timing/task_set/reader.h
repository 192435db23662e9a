// A set of bare tasks from CSV. The first column says what a line is, and so what its other columns are. Columns at
// the end of a line may be left out.
//
//   processor, name, policy, clock            policy: preemptive, non_preemptive, table
//   bus, name, policy, bit rate, clock        policy: can, can_extended, non_preemptive, table; bit rate of a CAN
//   task, name, resource, period, offset, jitter, best, worst, deadline, priority, communication
//   message, ... the same; on a CAN, worst is the payload in bytes, and best is blank
//   chain, name, stages, largest age          stages: a > b > c
//
// Blank fields: an offset is unknown, a jitter is 0, a best case is 0, a deadline is the period, priorities are
// assigned, communication is implicit, a clock is the one of all others with a blank one. Lines may come in any order.
// A line that begins with # is a comment, and a first line that begins with "kind" is a heading.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "schedules/timing/task_set/task_set.h"

namespace ttf::schedules::timing::task_set {

inline constexpr std::size_t kMostTasks = 1000, kMostChains = 1000;

// `name` is the file's, for messages. Throws InputError with all mistakes of the file.
TaskSet parse_task_set(std::string_view text, const std::string& name);

// Reads the file. Throws InputError.
TaskSet load_task_set(const std::string& path);

}  // namespace ttf::schedules::timing::task_set
