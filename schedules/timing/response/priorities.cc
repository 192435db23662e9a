#include "schedules/timing/response/priorities.h"

#include <algorithm>
#include <numeric>

namespace ttf::schedules::timing::response {
namespace {

PriorityOrder ordered_by(std::span<const TaskTimes> tasks, std::int64_t TaskTimes::*key) {
  PriorityOrder order(tasks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return tasks[a].*key < tasks[b].*key; });
  return order;
}

std::vector<TaskTimes> chosen_tasks(std::span<const TaskTimes> tasks, std::span<const std::size_t> places) {
  std::vector<TaskTimes> chosen;
  for (const std::size_t place : places) chosen.push_back(tasks[place]);
  return chosen;
}

}  // namespace

PriorityOrder rate_monotonic(std::span<const TaskTimes> tasks) { return ordered_by(tasks, &TaskTimes::period); }
PriorityOrder deadline_monotonic(std::span<const TaskTimes> tasks) { return ordered_by(tasks, &TaskTimes::deadline); }

std::optional<PriorityOrder> audsley(std::size_t count, const Fits& fits) {
  std::vector<std::size_t> open(count), placed;
  std::iota(open.begin(), open.end(), std::size_t{0});
  PriorityOrder lowest_first;
  while (!open.empty()) {
    const std::size_t before = open.size();
    for (std::size_t at = open.size(); at-- > 0;) {
      const std::size_t task = open[at];
      std::vector<std::size_t> higher = open;
      higher.erase(higher.begin() + static_cast<std::ptrdiff_t>(at));
      if (!fits(task, higher, placed)) continue;
      open = std::move(higher);
      placed.insert(std::upper_bound(placed.begin(), placed.end(), task), task);
      lowest_first.push_back(task);
      break;
    }
    if (open.size() == before) return std::nullopt;
  }
  std::reverse(lowest_first.begin(), lowest_first.end());
  return lowest_first;
}

std::optional<PriorityOrder> audsley_preemptive(std::span<const TaskTimes> tasks) {
  return audsley(tasks.size(), [&](std::size_t task, std::span<const std::size_t> higher, auto) {
    return preemptive_response(chosen_tasks(tasks, higher), tasks[task]).keeps(tasks[task].deadline);
  });
}

std::optional<PriorityOrder> audsley_non_preemptive(std::span<const TaskTimes> tasks) {
  return audsley(tasks.size(), [&](std::size_t task, std::span<const std::size_t> higher,
                                   std::span<const std::size_t> lower) {
    std::int64_t longest_lower = 0;
    for (const std::size_t one : lower) longest_lower = std::max(longest_lower, tasks[one].work);
    return non_preemptive_response(chosen_tasks(tasks, higher), tasks[task], longest_lower).keeps(tasks[task].deadline);
  });
}

}  // namespace ttf::schedules::timing::response
