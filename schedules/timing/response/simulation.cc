#include "schedules/timing/response/simulation.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <queue>
#include <set>
#include <utility>

#include "core/check.h"
#include "core/int128.h"
#include "schedules/timing/common_multiple.h"

namespace ttf::schedules::timing::response {
namespace {

class PreemptiveProcessor {
 public:
  PreemptiveProcessor(std::span<const PeriodicWork> tasks, std::int64_t hyperperiod,
                      const std::function<void(const EndedJob&)>& seen)
      : tasks_(tasks), hyperperiod_(hyperperiod), seen_(seen), waiting_(tasks.size()) {
    for (std::size_t i = 0; i < tasks.size(); ++i) arrivals_.push({tasks[i].offset % tasks[i].period, i});
  }

  void run() {
    while (arrivals_.top().first < 2 * hyperperiod_ || watched_ > 0) {
      if (ready_.empty()) now_ = std::max(now_, arrivals_.top().first);
      while (arrivals_.top().first <= now_) arrive();
      work_until(arrivals_.top().first);
    }
  }

 private:
  struct Job {
    std::int64_t arrival = 0;
    std::int64_t left = 0;
    std::optional<std::int64_t> start;
  };

  bool watched(std::int64_t arrival) const { return arrival >= hyperperiod_ && arrival < 2 * hyperperiod_; }

  void arrive() {
    const auto [at, i] = arrivals_.top();
    arrivals_.pop();
    arrivals_.push({at + tasks_[i].period, i});
    waiting_[i].push_back({.arrival = at, .left = tasks_[i].work, .start = {}});
    ready_.insert(i);
    if (watched(at)) ++watched_;
  }

  void work_until(std::int64_t next) {
    const std::size_t i = *ready_.begin();
    Job& job = waiting_[i].front();
    if (!job.start) job.start = now_;
    const std::int64_t slice = std::min(job.left, next - now_);
    now_ += slice;
    job.left -= slice;
    if (job.left > 0) return;
    if (watched(job.arrival)) {
      seen_({.task = i,
             .release = job.arrival - hyperperiod_,
             .start = *job.start - hyperperiod_,
             .end = now_ - hyperperiod_});
      --watched_;
    }
    waiting_[i].pop_front();
    if (waiting_[i].empty()) ready_.erase(i);
  }

  using Arrival = std::pair<std::int64_t, std::size_t>;

  std::span<const PeriodicWork> tasks_;
  std::int64_t hyperperiod_;
  const std::function<void(const EndedJob&)>& seen_;
  std::priority_queue<Arrival, std::vector<Arrival>, std::greater<>> arrivals_;
  std::vector<std::deque<Job>> waiting_;  // by task
  std::set<std::size_t> ready_;           // the highest priority first
  std::int64_t now_ = 0;
  std::int64_t watched_ = 0;  // jobs of the second hyperperiod that wait
};

}  // namespace

std::optional<std::int64_t> simulated_hyperperiod(std::span<const PeriodicWork> tasks, std::int64_t longest,
                                                  std::int64_t most_jobs) {
  std::optional<std::int64_t> hyperperiod = 1;
  for (const PeriodicWork& task : tasks) {
    TTF_CHECK(task.period >= 1 && task.offset >= 0 && task.work >= 0, "period {}, offset {}, work {}", task.period,
              task.offset, task.work);
    hyperperiod = common_multiple(*hyperperiod, task.period, longest);
    if (!hyperperiod) return std::nullopt;
  }
  Int128 jobs = 0, work = 0;
  for (const PeriodicWork& task : tasks) {
    const std::int64_t released = *hyperperiod / task.period;
    jobs += released;
    work += Int128{released} * task.work;
  }
  if (2 * jobs > most_jobs || work > *hyperperiod) return std::nullopt;
  return hyperperiod;
}

void simulate_jobs(std::span<const PeriodicWork> by_priority, std::int64_t hyperperiod,
                   const std::function<void(const EndedJob&)>& seen) {
  if (!by_priority.empty()) PreemptiveProcessor(by_priority, hyperperiod, seen).run();
}

std::optional<std::vector<std::int64_t>> simulated_responses(std::span<const TaskTimes> by_priority) {
  std::vector<PeriodicWork> tasks;
  for (const TaskTimes& task : by_priority) {
    TTF_CHECK(task.offset, "a simulated task needs an offset");
    tasks.push_back({.period = task.period, .offset = *task.offset, .work = task.work});
  }
  const auto hyperperiod = simulated_hyperperiod(tasks, kLongestArgument, kMostSimulatedJobs);
  if (!hyperperiod) return std::nullopt;
  std::vector<std::int64_t> longest(tasks.size(), 0);
  simulate_jobs(tasks, *hyperperiod,
                [&](const EndedJob& job) { longest[job.task] = std::max(longest[job.task], job.end - job.release); });
  return longest;
}

}  // namespace ttf::schedules::timing::response
