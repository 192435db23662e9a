#include "schedules/timing/task_set/resource_responses.h"

#include <algorithm>

#include "core/check.h"
#include "schedules/timing/response/can.h"
#include "schedules/timing/response/can_faults.h"
#include "schedules/timing/response/fixed_priority.h"
#include "schedules/timing/response/flexray_dynamic.h"
#include "schedules/timing/response/priorities.h"
#include "schedules/timing/response/tdma.h"

namespace ttf::schedules::timing::task_set {
namespace {

using response::Quality;
using response::Response;

constexpr double kLeastProbability = 1e-12;  // can_faults.h rounds to about 1e-13

std::vector<response::TaskTimes> as_tasks(const TaskSet& set, const PrioritisedTasks& on) {
  std::vector<response::TaskTimes> tasks;
  for (std::size_t p = 0; p < on.tasks.size(); ++p) {
    const Task& task = set.tasks[on.tasks[p]];
    tasks.push_back({.period = set.period_of(on.tasks[p]).ns,
                     .work = task.worst.ns,
                     .deadline = task.deadline.value_or(Duration{response::kLongestArgument}).ns,
                     .jitter = on.jitters[p].ns,
                     .blocking = 0,
                     .offset = task.offset ? std::optional(task.offset->ns) : std::nullopt});
  }
  return tasks;
}

std::vector<response::CanMessage> as_can_messages(const TaskSet& set, const PrioritisedTasks& on) {
  std::vector<response::CanMessage> messages;
  for (const response::TaskTimes& task : as_tasks(set, on))
    messages.push_back(
        {.period = task.period, .transmission = task.work, .deadline = task.deadline, .jitter = task.jitter});
  return messages;
}

response::CanBus as_bus(const Resource& can) {
  response::CanBus bus{.bit = response::can_time_ns(1, can.bit_rate), .errors = std::nullopt};
  if (can.errors_apart) bus.errors = response::CanErrors{.at_once = 1, .interarrival = can.errors_apart->ns};
  return bus;
}

std::vector<Response> on_dynamic_segment(const TaskSet& set, const PrioritisedTasks& on) {
  using Decision = response::DynamicSegment::Decision;
  const Resource& bus = set.resources[on.resource];
  std::vector<response::DynamicMessage> messages;
  for (std::size_t p = 0; p < on.tasks.size(); ++p) {
    const Task& task = set.tasks[on.tasks[p]];
    messages.push_back({.slot = static_cast<int>(*task.priority),
                        .base_cycle = task.base_cycle,
                        .repetition = task.repetition,
                        .minislots = task.minislots,
                        .latest_tx = task.latest_tx,
                        .period = set.period_of(on.tasks[p]).ns,
                        .jitter = on.jitters[p].ns});
  }
  const response::DynamicSegment segment{
      .cycle = bus.cycle.ns,
      .minislot = bus.minislot.ns,
      .minislots = bus.minislots,
      .decision = bus.decides_at_start ? Decision::kAtSegmentStart : Decision::kAtTurn};
  std::vector<Response> responses;
  for (const response::DynamicResponse& one : response::dynamic_responses(segment, messages))
    responses.push_back(one.response);
  return responses;
}

std::vector<Response> in_tdma_slots(const TaskSet& set, const PrioritisedTasks& on) {
  std::vector<Response> responses;
  for (std::size_t p = 0; p < on.tasks.size(); ++p) {
    const Task& task = set.tasks[on.tasks[p]];
    responses.push_back(response::tdma_response(
        {.length = task.slot.ns, .cycle = set.resources[on.resource].cycle.ns},
        {.period = set.period_of(on.tasks[p]).ns, .work = task.worst.ns, .jitter = on.jitters[p].ns}));
  }
  return responses;
}

std::vector<Response> by_theory(const TaskSet& set, const PrioritisedTasks& on) {
  const Resource& resource = set.resources[on.resource];
  switch (resource.policy) {
    case Policy::kPreemptive: return response::preemptive(as_tasks(set, on));
    case Policy::kNonPreemptive: return response::non_preemptive(as_tasks(set, on));
    case Policy::kCan:
    case Policy::kCanExtended: return response::can_responses(as_bus(resource), as_can_messages(set, on));
    case Policy::kDynamic: return on_dynamic_segment(set, on);
    case Policy::kTdma: return in_tdma_slots(set, on);
    case Policy::kTable: break;
  }
  TTF_CHECK(false, "{} is a table", resource.name);
  return {};
}

// Returns whether two tasks have one: a single offset says nothing of the others.
bool have_offsets(const TaskSet& set, std::span<const std::size_t> tasks) {
  return std::ranges::count_if(tasks, [&](std::size_t t) { return set.tasks[t].offset.has_value(); }) >= 2;
}

// Returns whether the longest of the lower priorities, which blocks the task at place `p`, is an activated one: it
// may never begin just before the task's release.
bool blocked_by_activated(const TaskSet& set, const PrioritisedTasks& on, std::size_t p) {
  Duration activated{}, free{};
  for (const std::size_t lower : on.tasks.subspan(p + 1)) {
    const Task& task = set.tasks[lower];
    Duration& longest = task.activator ? activated : free;
    longest = std::max(longest, task.worst);
  }
  return activated > free;
}

// Returns whether the set may have no case as bad as the analysis of the task at place `p`.
bool may_be_less(const TaskSet& set, const PrioritisedTasks& on, std::size_t p) {
  const Resource& resource = set.resources[on.resource];
  const auto activated = [&](std::size_t t) { return set.tasks[t].activator.has_value(); };
  if (resource.policy == Policy::kTdma) return activated(on.tasks[p]);
  if (std::ranges::any_of(on.tasks.first(p + 1), activated)) return true;
  if (resource.policy == Policy::kPreemptive) return false;
  if (resource.policy == Policy::kDynamic)
    return std::ranges::any_of(on.tasks.first(p), [&](std::size_t t) { return !set.tasks[t].is_event(); });
  return (resource.is_can() && have_offsets(set, on.tasks)) || blocked_by_activated(set, on, p);
}

}  // namespace

std::vector<Response> resource_responses(const TaskSet& set, const PrioritisedTasks& on) {
  std::vector<Response> responses = by_theory(set, on);
  for (std::size_t p = 0; p < responses.size(); ++p)
    if (responses[p].bounded() && may_be_less(set, on, p)) responses[p].quality = Quality::kBound;
  return responses;
}

std::optional<std::vector<std::size_t>> audsleys_order(const TaskSet& set, const PrioritisedTasks& on) {
  const Resource& resource = set.resources[on.resource];
  std::optional<response::PriorityOrder> order;
  if (resource.is_can())
    order = response::audsley_can(as_bus(resource), as_can_messages(set, on));
  else if (resource.policy == Policy::kPreemptive)
    order = response::audsley_preemptive(as_tasks(set, on));
  else
    order = response::audsley_non_preemptive(as_tasks(set, on));
  if (!order) return std::nullopt;
  return response::in_order(std::vector(on.tasks.begin(), on.tasks.end()), *order);
}

std::vector<double> miss_probabilities(const TaskSet& set, const PrioritisedTasks& on) {
  const Resource& can = set.resources[on.resource];
  if (can.errors_per_s == 0) return {};
  const std::vector<response::CanMessage> messages = as_can_messages(set, on);
  std::vector<double> probabilities(messages.size());
  std::int64_t longest_lower = 0;
  for (std::size_t p = messages.size(); p-- > 0;) {
    const auto higher = std::span(messages).first(p);
    const response::FaultyResponses faulty =
        response::responses_with_faults(as_bus(can).bit, can.errors_per_s * 1e-9, higher, messages[p], longest_lower);
    probabilities[p] = std::max(faulty.miss_probability, kLeastProbability);
    longest_lower = std::max(longest_lower, messages[p].transmission);
  }
  return probabilities;
}

}  // namespace ttf::schedules::timing::task_set
