#include "schedules/timing/task_set/simulated_jobs.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>

#include "core/int128.h"
#include "schedules/timing/chain/timetable.h"

namespace ttf::schedules::timing::task_set {
namespace {

// Returns the hyperperiod if its jobs can be simulated.
std::optional<std::int64_t> short_hyperperiod(std::span<const PeriodicTask> tasks) {
  std::int64_t hyperperiod = 1;
  for (const PeriodicTask& task : tasks) {
    const Int128 next = Int128{hyperperiod} / std::gcd(hyperperiod, task.period.ns) * task.period.ns;
    if (next > chain::kLongest.ns / 4) return std::nullopt;  // the last ends are less than two hyperperiods later
    hyperperiod = static_cast<std::int64_t>(next);
  }
  Int128 jobs = 0, work = 0;
  for (const PeriodicTask& task : tasks) {
    jobs += Int128{2} * (hyperperiod / task.period.ns);
    work += Int128{hyperperiod / task.period.ns} * task.worst.ns;
  }
  if (jobs > kMostSimulated || work > hyperperiod) return std::nullopt;
  return hyperperiod;
}

// One processor, until all jobs have ended that are released in two hyperperiods. Later ones may delay these.
class Processor {
 public:
  Processor(std::span<const PeriodicTask> tasks, std::int64_t hyperperiod, bool worst)
      : tasks_(tasks), end_(2 * hyperperiod), worst_(worst), runs_(tasks.size()) {
    for (std::size_t t = 0; t < tasks.size(); ++t) start_anew(t);
    for (const PeriodicTask& task : tasks) left_ += end_ / task.period.ns;
  }

  // Calls seen(task, release, start, end) for each job.
  template <class Seen> void run(Seen seen) {
    while (left_ > 0) {
      const std::size_t t = highest_pending();
      if (t == tasks_.size()) {
        now_ = next_release(tasks_.size());
        continue;
      }
      Run& run = runs_[t];
      if (!run.start) run.start = now_;
      const std::int64_t until = std::min(now_ + run.left, next_release(t));
      run.left -= until - now_;
      now_ = until;
      if (run.left > 0) continue;
      if (release(t) < end_) --left_;
      seen(t, release(t), *run.start, now_);
      ++run.job;
      start_anew(t);
    }
  }

 private:
  struct Run {
    std::int64_t job = 0;  // the first that has not ended
    std::int64_t left = 0;
    std::optional<std::int64_t> start;
  };

  void start_anew(std::size_t t) {
    runs_[t].left = worst_ ? tasks_[t].worst.ns : tasks_[t].best.ns;
    runs_[t].start.reset();
  }
  std::int64_t release(std::size_t t) const {
    return tasks_[t].offset.ns % tasks_[t].period.ns + runs_[t].job * tasks_[t].period.ns;
  }
  std::size_t highest_pending() const {
    for (std::size_t t = 0; t < tasks_.size(); ++t)
      if (release(t) <= now_) return t;
    return tasks_.size();
  }
  // Returns the next release of the tasks before `t`, which are not pending.
  std::int64_t next_release(std::size_t t) const {
    std::int64_t next = std::numeric_limits<std::int64_t>::max();
    for (std::size_t higher = 0; higher < t; ++higher) next = std::min(next, release(higher));
    return next;
  }

  std::span<const PeriodicTask> tasks_;
  std::int64_t end_;
  bool worst_;
  std::vector<Run> runs_;
  std::int64_t now_ = 0;
  std::int64_t left_ = 0;  // jobs of the two hyperperiods
};

}  // namespace

std::optional<SimulatedJobs> simulated_jobs(std::span<const PeriodicTask> by_priority) {
  const std::optional<std::int64_t> hyperperiod = short_hyperperiod(by_priority);
  if (!hyperperiod) return std::nullopt;
  SimulatedJobs found{.hyperperiod = Duration{*hyperperiod}, .jobs = {}};
  for (const PeriodicTask& task : by_priority)
    found.jobs.emplace_back(static_cast<std::size_t>(*hyperperiod / task.period.ns));
  const auto place = [&](std::size_t t, std::int64_t release) -> chain::Job* {
    if (release < *hyperperiod || release >= 2 * *hyperperiod) return nullptr;
    return &found.jobs[t][static_cast<std::size_t>((release - *hyperperiod) / by_priority[t].period.ns)];
  };
  Processor(by_priority, *hyperperiod, false).run([&](std::size_t t, std::int64_t release, std::int64_t start, auto) {
    if (chain::Job* const job = place(t, release)) job->reads = Duration{start - *hyperperiod};
  });
  Processor(by_priority, *hyperperiod, true).run([&](std::size_t t, std::int64_t release, auto, std::int64_t end) {
    if (chain::Job* const job = place(t, release)) job->writes = Duration{end - *hyperperiod};
  });
  return found;
}

}  // namespace ttf::schedules::timing::task_set
