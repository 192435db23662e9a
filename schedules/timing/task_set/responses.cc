#include "schedules/timing/task_set/responses.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "schedules/timing/response/can.h"
#include "schedules/timing/response/fixed_priority.h"
#include "schedules/timing/response/priorities.h"
#include "schedules/timing/task_set/table.h"

namespace ttf::schedules::timing::task_set {
namespace {

using response::Quality;
using response::Response;

constexpr int kMostRounds = 1000;
constexpr Duration kLongestJitter{response::kLongestArgument / 2};

response::Task as_response_task(const TaskSet& set, std::size_t t, Duration jitter) {
  const Task& task = set.tasks[t];
  const Duration deadline = task.deadline.value_or(Duration{response::kLongestArgument});
  return {.period = set.period_of(t).ns,
          .work = task.worst.ns,
          .deadline = deadline.ns,
          .jitter = jitter.ns,
          .blocking = 0,
          .offset = task.offset ? std::optional(task.offset->ns) : std::nullopt};
}

response::CanMessage as_message(const response::Task& task) {
  return {.period = task.period, .transmission = task.work, .deadline = task.deadline, .jitter = task.jitter};
}

response::CanBus as_bus(const Resource& can) {
  return {.bit = response::can_time_ns(1, can.bit_rate), .errors = std::nullopt};
}

std::vector<response::CanMessage> as_messages(const std::vector<response::Task>& tasks) {
  std::vector<response::CanMessage> messages;
  for (const response::Task& task : tasks) messages.push_back(as_message(task));
  return messages;
}

class Analysis {
 public:
  explicit Analysis(const TaskSet& set) : set_(set), unknown_(set.tasks.size()) {
    found_.tasks.resize(set.tasks.size());
    for (std::size_t r = 0; r < set.resources.size(); ++r) found_.resources.push_back(in_first_order(r));
  }

  Responses run() {
    iterate();
    for (std::size_t r = 0; r < set_.resources.size(); ++r) {
      ResourceTiming& here = found_.resources[r];
      if (here.assignment != Assignment::kDeadlineMonotonic || all_in_time(r)) continue;
      const std::vector<std::size_t> before = here.by_priority;
      here.assignment = Assignment::kNone;
      const std::optional<std::vector<std::size_t>> order = audsleys_order(r);
      if (!order) continue;
      here.by_priority = *order;
      iterate();
      if (all_in_time(r)) {
        here.assignment = Assignment::kAudsley;
        continue;
      }
      here.by_priority = before;
      iterate();
    }
    return std::move(found_);
  }

 private:
  ResourceTiming in_first_order(std::size_t r) const {
    ResourceTiming here;
    here.by_priority = set_.tasks_on(r);
    std::vector<TableEntry> table;
    bool given = false;
    for (const std::size_t t : here.by_priority) {
      const Task& task = set_.tasks[t];
      here.load += task.worst.seconds() / set_.period_of(t).seconds();
      given = given || task.priority.has_value();
      table.push_back({.period = set_.period_of(t), .offset = task.offset.value_or(Duration{}), .worst = task.worst});
    }
    if (set_.resources[r].policy == Policy::kTable) {
      if (const auto overlap = overlap_in(table))
        here.overlap = {here.by_priority[overlap->first], here.by_priority[overlap->second]};
      return here;
    }
    const auto key = [&](std::size_t t) {
      const Task& task = set_.tasks[t];
      if (given) return task.priority.value_or(0);
      return task.deadline ? task.deadline->ns : std::numeric_limits<std::int64_t>::max();
    };
    std::ranges::stable_sort(here.by_priority, {}, key);
    here.assignment = given ? Assignment::kGiven : Assignment::kDeadlineMonotonic;
    return here;
  }

  // Begins without jitters of activations, which then only grow.
  void iterate() {
    unknown_.assign(set_.tasks.size(), false);
    for (std::size_t t = 0; t < set_.tasks.size(); ++t) {
      found_.tasks[t] = TaskTiming{};
      found_.tasks[t].jitter = set_.tasks[t].jitter;
    }
    for (int round = 0;; ++round) {
      for (std::size_t r = 0; r < set_.resources.size(); ++r) respond(r);
      if (!activations_change(round >= kMostRounds)) return;
    }
  }

  void respond(std::size_t r) {
    const std::vector<std::size_t>& order = found_.resources[r].by_priority;
    const std::vector<Response> responses = responses_on(r);
    const bool apart = set_.resources[r].is_can() && have_offsets(order);  // can.h knows no offsets
    bool bounded = true, activated = false;
    for (std::size_t p = 0; p < order.size(); ++p) {
      TaskTiming& timing = found_.tasks[order[p]];
      bounded = bounded && !unknown_[order[p]];
      activated = activated || set_.tasks[order[p]].activator;
      timing.response = bounded ? responses[p] : Response{};
      // The activators' worst cases may never come together, nor messages with known offsets.
      const bool may_be_less = activated || apart || blocked_by_activated(r, p);
      if (may_be_less && timing.bounded()) timing.response.quality = Quality::kBound;
    }
  }

  // Returns whether two tasks have one: a single offset says nothing of the others.
  bool have_offsets(const std::vector<std::size_t>& tasks) const {
    return std::ranges::count_if(tasks, [&](std::size_t t) { return set_.tasks[t].offset.has_value(); }) >= 2;
  }

  // Returns whether the longest of the lower priorities, which blocks the task at place `p`, is an activated one: it
  // may never begin just before the task's release.
  bool blocked_by_activated(std::size_t r, std::size_t p) const {
    if (set_.resources[r].policy == Policy::kPreemptive) return false;
    const std::vector<std::size_t>& order = found_.resources[r].by_priority;
    Duration activated{}, free{};
    for (std::size_t lower = p + 1; lower < order.size(); ++lower) {
      const Task& task = set_.tasks[order[lower]];
      Duration& longest = task.activator ? activated : free;
      longest = std::max(longest, task.worst);
    }
    return activated > free;
  }

  std::vector<Response> responses_on(std::size_t r) const {
    const Resource& resource = set_.resources[r];
    std::vector<response::Task> tasks;
    for (const std::size_t t : found_.resources[r].by_priority)
      tasks.push_back(as_response_task(set_, t, unknown_[t] ? Duration{} : found_.tasks[t].jitter));
    switch (resource.policy) {
      case Policy::kPreemptive: return response::preemptive(tasks);
      case Policy::kNonPreemptive: return response::non_preemptive(tasks);
      case Policy::kCan:
      case Policy::kCanExtended: return response::can_responses(as_bus(resource), as_messages(tasks));
      case Policy::kTable: break;
    }
    std::vector<Response> responses;
    const bool overlaps = !found_.resources[r].overlap.empty();
    for (const response::Task& task : tasks)
      responses.push_back(overlaps ? Response{} : Response{.quality = Quality::kExact, .longest = task.work});
    return responses;
  }

  // Takes responses into jitters; returns whether anything has changed. `stop` gives up the jitters that still grow.
  bool activations_change(bool stop) {
    bool changed = false;
    for (std::size_t t = 0; t < set_.tasks.size(); ++t) {
      const Task& task = set_.tasks[t];
      TaskTiming next = found_.tasks[t];
      Duration start{};
      if (task.activator) {
        const TaskTiming& before = found_.tasks[*task.activator];
        start = before.shortest;
        next.jitter = before.longest - before.shortest;
        const bool gives_up = stop && next.jitter != found_.tasks[t].jitter;
        if (!unknown_[t] && (gives_up || !activates(*task.activator) || next.jitter > kLongestJitter))
          unknown_[t] = changed = true;
        if (unknown_[t]) next.jitter = Duration{};
      }
      const bool let = task.communication == Communication::kLet;
      next.shortest = start + (let ? *task.deadline : task.best);
      next.longest = start + (let ? *task.deadline : Duration{next.response.longest});
      const TaskTiming& last = found_.tasks[t];
      if (next.jitter != last.jitter || next.shortest != last.shortest || next.longest != last.longest) changed = true;
      found_.tasks[t] = next;
    }
    return changed;
  }

  // Returns whether the task's longest time is known, so that it activates another one by then.
  bool activates(std::size_t t) const {
    const Task& task = set_.tasks[t];
    if (unknown_[t] || !found_.tasks[t].bounded()) return false;
    return task.communication != Communication::kLet || found_.tasks[t].response.meets(task.deadline->ns);
  }

  bool all_in_time(std::size_t r) const {
    return std::ranges::all_of(found_.resources[r].by_priority,
                               [&](std::size_t t) { return meets_deadline(set_, found_, t); });
  }

  std::optional<std::vector<std::size_t>> audsleys_order(std::size_t r) const {
    const std::vector<std::size_t>& places = found_.resources[r].by_priority;
    std::vector<response::Task> tasks;
    for (const std::size_t t : places) {
      if (unknown_[t]) return std::nullopt;
      tasks.push_back(as_response_task(set_, t, found_.tasks[t].jitter));
    }
    const Resource& resource = set_.resources[r];
    std::optional<response::PriorityOrder> order;
    if (resource.is_can())
      order = response::audsley_can(as_bus(resource), as_messages(tasks));
    else if (resource.policy == Policy::kPreemptive)
      order = response::audsley_preemptive(tasks);
    else
      order = response::audsley_non_preemptive(tasks);
    if (!order) return std::nullopt;
    return response::in_order(places, *order);
  }

  const TaskSet& set_;
  std::vector<bool> unknown_;  // an activated task whose jitter has no bound
  Responses found_;
};

}  // namespace

Responses responses_of(const TaskSet& set) { return Analysis(set).run(); }

bool meets_deadline(const TaskSet& set, const Responses& responses, std::size_t task) {
  const response::Response& found = responses.tasks[task].response;
  if (!set.tasks[task].deadline) return found.bounded();
  return found.meets(set.tasks[task].deadline->ns);
}

std::string words(Assignment assignment) {
  switch (assignment) {
    case Assignment::kGiven: return "as given";
    case Assignment::kDeadlineMonotonic: return "deadline monotonic";
    case Assignment::kAudsley: return "by Audsley's algorithm";
    case Assignment::kNone: break;
  }
  return "deadline monotonic (no order found that meets all deadlines)";
}

}  // namespace ttf::schedules::timing::task_set
