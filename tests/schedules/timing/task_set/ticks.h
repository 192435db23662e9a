// A second opinion on processors: whole ticks, one after the other, on all processors at once.
//
// In each tick a processor works on the pending task of the highest priority. Without preemption it ends a begun job
// first. The end of a job releases a job of each task that it activates, which a processor may begin at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/random.h"

namespace ttf::schedules::timing::task_set {

struct TickTask {
  std::size_t processor = 0;
  int priority = 0;  // unique on its processor, the smallest first
  bool preemptive = true;
  std::int64_t period = 1, offset = 0;
  std::int64_t best = 1, worst = 1;
  std::optional<std::size_t> activator;
};

struct TickJob {
  std::int64_t release = 0, start = 0, end = 0;
};

class Ticks {
 public:
  // Work is drawn from the stream, or is always the worst without one.
  Ticks(const std::vector<TickTask>& tasks, RandomStream* stream)
      : tasks_(tasks), stream_(stream), pending_(tasks.size()), done_(tasks.size()) {}

  // Returns the jobs of each task that end within the horizon.
  std::vector<std::vector<TickJob>> run(std::size_t processors, std::int64_t horizon) {
    for (std::int64_t now = 0; now < horizon; ++now) {
      for (std::size_t t = 0; t < tasks_.size(); ++t)
        if (!tasks_[t].activator && now >= tasks_[t].offset && (now - tasks_[t].offset) % tasks_[t].period == 0)
          release(t, now);
      std::vector<std::size_t> ended;
      for (std::size_t p = 0; p < processors; ++p)
        if (const auto t = chosen_on(p); t && works(*t, now)) ended.push_back(*t);
      for (const std::size_t end : ended)  // the next tick sees what they release
        for (std::size_t t = 0; t < tasks_.size(); ++t)
          if (tasks_[t].activator == end) release(t, now + 1);
    }
    return done_;
  }

 private:
  struct Pending {
    TickJob job;
    std::int64_t left = 0;
    bool begun = false;
  };

  void release(std::size_t t, std::int64_t now) {
    const std::int64_t work = stream_ != nullptr ? stream_->integer(tasks_[t].best, tasks_[t].worst) : tasks_[t].worst;
    pending_[t].push_back({.job = {.release = now, .start = 0, .end = 0}, .left = work, .begun = false});
  }

  std::optional<std::size_t> chosen_on(std::size_t processor) const {
    std::optional<std::size_t> chosen;
    for (std::size_t t = 0; t < tasks_.size(); ++t) {
      if (tasks_[t].processor != processor || pending_[t].empty()) continue;
      if (!tasks_[t].preemptive && pending_[t].front().begun) return t;
      if (!chosen || tasks_[t].priority < tasks_[*chosen].priority) chosen = t;
    }
    return chosen;
  }

  // Returns whether the job ends.
  bool works(std::size_t t, std::int64_t now) {
    Pending& one = pending_[t].front();
    if (!one.begun) one.job.start = now;
    one.begun = true;
    if (--one.left > 0) return false;
    one.job.end = now + 1;
    done_[t].push_back(one.job);
    pending_[t].pop_front();
    return true;
  }

  const std::vector<TickTask>& tasks_;
  RandomStream* stream_;
  std::vector<std::deque<Pending>> pending_;
  std::vector<std::vector<TickJob>> done_;
};

}  // namespace ttf::schedules::timing::task_set
