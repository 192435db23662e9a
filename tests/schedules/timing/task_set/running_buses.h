// Second opinions on buses and slots, event by event: they use no theory. Times are nanoseconds.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

namespace ttf::schedules::timing::task_set {

// A job that counts from `arrival` and waits from `queued` on.
struct BusJob {
  std::int64_t arrival = 0, queued = 0;
};

using BusJobs = std::vector<std::vector<BusJob>>;  // by message, in the order of their queueing

// Takes the longest time from arrival to end, by message.
class LongestEnds {
 public:
  explicit LongestEnds(std::size_t messages) : longest(messages) {}
  void end(std::size_t message, const BusJob& job, std::int64_t now) {
    longest[message] = std::max(longest[message], now - job.arrival);
  }
  std::vector<std::int64_t> longest;
};

// A slot that is open from `phase` on for `length`, once a cycle. Work of one job may take several slots.
inline std::int64_t longest_in_slot(const std::vector<BusJob>& jobs, std::int64_t work, std::int64_t length,
                                    std::int64_t cycle, std::int64_t phase) {
  LongestEnds ends(1);
  std::int64_t now = 0;
  for (const BusJob& job : jobs) {
    now = std::max(now, job.queued);
    for (std::int64_t left = work; left > 0;) {
      const std::int64_t inside = ((now - phase) % cycle + cycle) % cycle;
      if (inside >= length) {
        now += cycle - inside;
        continue;
      }
      const std::int64_t slice = std::min(left, length - inside);
      now += slice;
      left -= slice;
    }
    ends.end(0, job, now);
  }
  return ends.longest[0];
}

struct RunningFrame {
  int slot = 1, base_cycle = 0, repetition = 1;
  std::int64_t minislots = 1, latest_tx = 1;
};

struct RunningSegment {
  std::int64_t cycle = 0, minislot = 0;
  bool decides_at_start = false;
};

// Segments begin at each multiple of the cycle. Frames are in the order of slots. Runs until all jobs are sent, or for
// `most_cycles`.
inline std::vector<std::int64_t> longest_in_segments(const std::vector<RunningFrame>& frames, const BusJobs& jobs,
                                                     const RunningSegment& segment, std::int64_t most_cycles) {
  LongestEnds ends(frames.size());
  std::vector<std::size_t> next(frames.size());
  for (std::int64_t cycle = 0; cycle < most_cycles; ++cycle) {
    std::int64_t minislot = 1;
    int slot = 1;
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const RunningFrame& frame = frames[f];
      if (cycle % frame.repetition != frame.base_cycle) continue;
      if (frame.slot > slot) {  // silent slots
        minislot += frame.slot - slot;
        slot = frame.slot;
      }
      const std::int64_t start = cycle * segment.cycle;
      const std::int64_t turn = start + (minislot - 1) * segment.minislot;
      const std::int64_t decided = segment.decides_at_start ? start : turn;
      if (next[f] < jobs[f].size() && jobs[f][next[f]].queued <= decided && minislot <= frame.latest_tx) {
        ends.end(f, jobs[f][next[f]++], turn + frame.minislots * segment.minislot);
        minislot += frame.minislots;
        ++slot;
      }
    }
  }
  return ends.longest;
}

// A CAN: the message of the lowest place that waits as the bus becomes idle is sent. An error ends the frame that it
// strikes; after an error frame the bus is idle.
inline std::vector<std::int64_t> longest_on_can(const std::vector<std::int64_t>& transmissions, const BusJobs& jobs,
                                                const std::vector<std::int64_t>& errors, std::int64_t error_frame) {
  constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  LongestEnds ends(transmissions.size());
  std::vector<std::size_t> next(transmissions.size());
  std::size_t error = 0;
  for (std::int64_t now = 0; now < kNever;) {
    std::size_t chosen = transmissions.size();
    std::int64_t soonest = kNever;
    for (std::size_t m = transmissions.size(); m-- > 0;) {
      if (next[m] == jobs[m].size()) continue;
      soonest = std::min(soonest, jobs[m][next[m]].queued);
      if (jobs[m][next[m]].queued <= now) chosen = m;
    }
    if (chosen == transmissions.size()) {
      now = soonest;
      continue;
    }
    while (error < errors.size() && errors[error] < now) ++error;  // on an idle bus, or in an error frame
    if (error < errors.size() && errors[error] < now + transmissions[chosen]) {
      now = errors[error++] + error_frame;
      continue;
    }
    now += transmissions[chosen];
    ends.end(chosen, jobs[chosen][next[chosen]++], now);
  }
  return ends.longest;
}

}  // namespace ttf::schedules::timing::task_set
