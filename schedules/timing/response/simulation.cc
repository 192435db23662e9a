#include "schedules/timing/response/simulation.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <queue>
#include <set>
#include <utility>

#include "core/check.h"
#include "schedules/timing/response/recurrence.h"

namespace ttf::schedules::timing::response {
namespace {

class PreemptiveProcessor {
 public:
  PreemptiveProcessor(std::span<const Task> tasks, std::int64_t repeats)
      : tasks_(tasks), repeats_(repeats), waiting_(tasks.size()), longest_(tasks.size(), 0) {
    for (std::size_t i = 0; i < tasks.size(); ++i) arrivals_.push({*tasks[i].offset % tasks[i].period, i});
  }

  std::vector<std::int64_t> run() {
    while (arrivals_.top().first < 2 * repeats_ || watched_ > 0) {
      if (ready_.empty()) now_ = std::max(now_, arrivals_.top().first);
      while (arrivals_.top().first <= now_) arrive();
      work_until(arrivals_.top().first);
    }
    return longest_;
  }

 private:
  struct Job {
    std::int64_t arrival = 0;
    std::int64_t left = 0;
  };

  bool watched(std::int64_t arrival) const { return arrival >= repeats_ && arrival < 2 * repeats_; }

  void arrive() {
    const auto [at, i] = arrivals_.top();
    arrivals_.pop();
    arrivals_.push({at + tasks_[i].period, i});
    waiting_[i].push_back({at, tasks_[i].work});
    ready_.insert(i);
    if (watched(at)) ++watched_;
  }

  void work_until(std::int64_t next) {
    const std::size_t i = *ready_.begin();
    Job& job = waiting_[i].front();
    const std::int64_t slice = std::min(job.left, next - now_);
    now_ += slice;
    job.left -= slice;
    if (job.left > 0) return;
    if (watched(job.arrival)) {
      longest_[i] = std::max(longest_[i], now_ - job.arrival);
      --watched_;
    }
    waiting_[i].pop_front();
    if (waiting_[i].empty()) ready_.erase(i);
  }

  using Arrival = std::pair<std::int64_t, std::size_t>;

  std::span<const Task> tasks_;
  std::int64_t repeats_;
  std::priority_queue<Arrival, std::vector<Arrival>, std::greater<>> arrivals_;
  std::vector<std::deque<Job>> waiting_;  // by task
  std::set<std::size_t> ready_;           // the highest priority first
  std::int64_t now_ = 0;
  std::int64_t watched_ = 0;  // jobs of the second hyperperiod that wait
  std::vector<std::int64_t> longest_;
};

}  // namespace

std::optional<std::vector<std::int64_t>> simulated_responses(std::span<const Task> by_priority) {
  if (by_priority.empty()) return std::vector<std::int64_t>{};
  std::vector<Source> sources;
  for (const Task& task : by_priority) {
    TTF_CHECK(task.offset && *task.offset >= 0, "a simulated task needs an offset");
    TTF_CHECK(task.period >= 1 && task.work >= 1, "period {}, work {}", task.period, task.work);
    sources.push_back({task.period, 0, task.work});
  }
  const auto repeats = hyperperiod(sources);
  if (!repeats || *repeats > kLongestArgument || load_of(sources) == Load::kAbove) return std::nullopt;
  Int128 jobs = 0;
  for (const Source& one : sources) jobs += static_cast<Int128>(2) * (*repeats / one.period);
  if (jobs > kMostSimulatedJobs) return std::nullopt;
  return PreemptiveProcessor(by_priority, *repeats).run();
}

}  // namespace ttf::schedules::timing::response
