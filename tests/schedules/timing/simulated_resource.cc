#include "tests/schedules/timing/simulated_resource.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace ttf::schedules::timing {

std::vector<std::int64_t> simulated_ends(const std::vector<SimulatedJob>& jobs, Preemption preemption,
                                         std::int64_t begin) {
  std::vector<std::size_t> order(jobs.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return jobs[a].released < jobs[b].released; });
  std::vector<std::int64_t> ends(jobs.size()), left(jobs.size());
  std::set<std::tuple<std::size_t, std::int64_t, std::size_t>> waiting;  // task, arrival, job
  std::int64_t now = begin;
  for (std::size_t next = 0; next < order.size() || !waiting.empty();) {
    if (waiting.empty()) now = std::max(now, jobs[order[next]].released);
    for (; next < order.size() && jobs[order[next]].released <= now; ++next) {
      const SimulatedJob& job = jobs[order[next]];
      left[order[next]] = job.work;
      waiting.insert({job.task, job.arrival, order[next]});
    }
    const std::size_t job = std::get<2>(*waiting.begin());
    std::int64_t until = now + left[job];
    if (preemption == Preemption::kAlways && next < order.size()) until = std::min(until, jobs[order[next]].released);
    left[job] -= until - now;
    now = until;
    if (left[job] > 0) continue;
    ends[job] = now;
    waiting.erase(waiting.begin());
  }
  return ends;
}

std::vector<std::int64_t> simulated_longest(const std::vector<SimulatedJob>& jobs, std::size_t tasks,
                                            Preemption preemption, std::int64_t begin) {
  const std::vector<std::int64_t> ends = simulated_ends(jobs, preemption, begin);
  std::vector<std::int64_t> longest(tasks, 0);
  for (std::size_t i = 0; i < jobs.size(); ++i)
    longest[jobs[i].task] = std::max(longest[jobs[i].task], ends[i] - jobs[i].arrival);
  return longest;
}

}  // namespace ttf::schedules::timing
