// A set of bare tasks from CSV. The first column says what a line is, and so what its other columns are. Columns at
// the end of a line may be left out.
//
//   processor, name, policy, clock, cycle     policy: preemptive, non_preemptive, tdma, table; cycle of tdma
//   bus, name, policy, bit rate, clock, cycle, minislots, minislot, decision, errors
//                                             policy: can, can_extended, dynamic, tdma, non_preemptive, table; bit rate
//                                             and errors of a CAN; minislots and decision (turn, start) of dynamic
//   task, name, resource, period, offset, jitter, best, worst, deadline, priority, communication, slot
//   message, ... the same, cycles, latest tx  on a CAN, worst is the payload in bytes, and best is blank; on a dynamic
//                                             segment both are minislots, and the priority is the slot's number
//   chain, name, stages, largest age          stages: a > b > c
//
// Blank fields: an offset is unknown, a jitter is 0, a best case is 0, a deadline is the period, priorities are
// assigned, communication is implicit, a clock is the one of all others with a blank one, a controller decides at each
// turn, there are no errors, a frame has all cycles, and pLatestTx lets it just fit. Lines may come in any order.
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
