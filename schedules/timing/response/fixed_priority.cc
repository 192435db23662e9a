#include "schedules/timing/response/fixed_priority.h"

#include <algorithm>

#include "core/check.h"
#include "schedules/timing/response/offsets.h"
#include "schedules/timing/response/recurrence.h"
#include "schedules/timing/response/simulation.h"

namespace ttf::schedules::timing::response {
namespace {

void check_range(const TaskTimes& task) {
  for (const std::int64_t time : {task.period, task.work, task.deadline, task.jitter, task.blocking})
    TTF_CHECK(time >= 0 && time <= kLongestArgument, "a time of {}", time);
}

Source source_of(const TaskTimes& task) {
  check_range(task);
  return {task.period, task.jitter, task.work};
}

Level task_level(std::span<const TaskTimes> higher, const TaskTimes& task) {
  Level level{.blocking = 0, .own = source_of(task), .others = {}, .tail = 0, .tick = 0, .errors = {}};
  for (const TaskTimes& other : higher) level.others.push_back(source_of(other));
  return level;
}

Response at_best_a_bound(Response response) {
  if (response.quality == Quality::kExact) response.quality = Quality::kBound;
  return response;
}

// Returns how many of the first tasks can be simulated: each of them has an offset, without jitter and blocking.
std::size_t strictly_periodic(std::span<const TaskTimes> by_priority) {
  const auto end = std::find_if(by_priority.begin(), by_priority.end(), [](const TaskTimes& task) {
    return !task.offset || task.jitter != 0 || task.blocking != 0;
  });
  return static_cast<std::size_t>(end - by_priority.begin());
}

}  // namespace

Response preemptive_response(std::span<const TaskTimes> higher, const TaskTimes& task) {
  Level level = task_level(higher, task);
  level.blocking = task.blocking;
  const Response response = longest_response(level);
  const bool offsets =
      task.offset || std::any_of(higher.begin(), higher.end(), [](const TaskTimes& other) { return !!other.offset; });
  return offsets || task.blocking > 0 ? at_best_a_bound(response) : response;
}

Response non_preemptive_response(std::span<const TaskTimes> higher, const TaskTimes& task, std::int64_t longest_lower) {
  Level level = task_level(higher, task);
  level.blocking = std::max<std::int64_t>(0, longest_lower - 1);
  level.tail = task.work;
  level.tick = 1;
  return longest_response(level);
}

std::vector<Response> preemptive(std::span<const TaskTimes> by_priority) {
  std::vector<Response> responses;
  for (std::size_t i = 0; i < by_priority.size(); ++i)
    responses.push_back(preemptive_response(by_priority.first(i), by_priority[i]));
  // Where all first tasks have offsets, simulation is exact. Fewer of them may fit the limit on jobs.
  for (std::size_t known = strictly_periodic(by_priority); known > 0; --known) {
    const auto simulated = simulated_responses(by_priority.first(known));
    if (!simulated) continue;
    for (std::size_t i = 0; i < known; ++i) responses[i] = {Quality::kExact, (*simulated)[i]};
    break;
  }
  for (std::size_t i = 0; i < by_priority.size(); ++i) {
    if (responses[i].quality != Quality::kBound) continue;
    const auto found = response_with_offsets(by_priority.first(i), by_priority[i]);
    if (found) responses[i] = {Quality::kExact, *found};
  }
  return responses;
}

std::vector<Response> non_preemptive(std::span<const TaskTimes> by_priority) {
  std::vector<Response> responses(by_priority.size());
  const bool offsets =
      std::any_of(by_priority.begin(), by_priority.end(), [](const TaskTimes& task) { return !!task.offset; });
  std::int64_t longest_lower = 0;
  for (std::size_t i = by_priority.size(); i-- > 0;) {
    const Response response = non_preemptive_response(by_priority.first(i), by_priority[i], longest_lower);
    responses[i] = offsets ? at_best_a_bound(response) : response;
    longest_lower = std::max(longest_lower, by_priority[i].work);
  }
  return responses;
}

}  // namespace ttf::schedules::timing::response
