#include "schedules/timing/task_set/task_set.h"

#include "core/check.h"

namespace ttf::schedules::timing::task_set {

std::vector<std::size_t> TaskSet::tasks_on(std::size_t resource) const {
  std::vector<std::size_t> found;
  for (std::size_t t = 0; t < tasks.size(); ++t)
    if (tasks[t].resource == resource) found.push_back(t);
  return found;
}

Duration TaskSet::period_of(std::size_t task) const {
  while (tasks[task].activator) task = *tasks[task].activator;
  TTF_CHECK(tasks[task].period.has_value(), "{} has no period", tasks[task].name);
  return *tasks[task].period;
}

const char* word(Policy policy) {
  switch (policy) {
    case Policy::kPreemptive: return "preemptive";
    case Policy::kNonPreemptive: return "non_preemptive";
    case Policy::kCan: return "can";
    case Policy::kCanExtended: return "can_extended";
    case Policy::kDynamic: return "dynamic";
    case Policy::kTdma: return "tdma";
    case Policy::kTable: break;
  }
  return "table";
}

const char* word(Communication communication) {
  switch (communication) {
    case Communication::kImplicit: return "implicit";
    case Communication::kLet: return "let";
    case Communication::kEvent: break;
  }
  return "event";
}

}  // namespace ttf::schedules::timing::task_set
