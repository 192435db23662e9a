// The columns whose meaning depends on the policy: the line of a processor or a bus, and the work of its tasks.
#pragma once

#include <string_view>

#include "schedules/timing/task_set/fields.h"
#include "schedules/timing/task_set/task_set.h"

namespace ttf::schedules::timing::task_set {

inline constexpr std::string_view kProcessorColumns[] = {"kind", "name", "policy", "clock", "cycle"};
inline constexpr std::string_view kBusColumns[] = {"kind",  "name",      "policy",   "bit rate", "clock",
                                                   "cycle", "minislots", "minislot", "decision", "errors"};

// Returns the resource of a line whose first field is "processor" or "bus". Mistakes go to the line's findings.
Resource read_resource(Fields& fields);

// Reads best, worst, priority, slot, cycles and latest tx into `one`. Mistakes go to the line's findings.
void read_work(Fields& fields, const Resource& on, Task& one);

}  // namespace ttf::schedules::timing::task_set
