#include "schedules/timing/response/offsets.h"

#include <algorithm>
#include <vector>

#include "schedules/timing/common_multiple.h"
#include "schedules/timing/response/recurrence.h"

namespace ttf::schedules::timing::response {
namespace {

constexpr std::int64_t kLongestRound = std::int64_t{1} << 58;  // hyperperiods and busy periods
constexpr std::int64_t kMostCandidates = 50'000;

// Times here are below 2^60, and divisions of 64 bits are much faster.
std::int64_t ceiling(std::int64_t dividend, std::int64_t divisor) {
  return dividend >= 0 ? (dividend + divisor - 1) / divisor : -(-dividend / divisor);
}

class OffsetAnalysis {
 public:
  OffsetAnalysis(std::span<const TaskTimes> higher, const TaskTimes& task) : higher_(higher), task_(task) {}

  std::optional<std::int64_t> longest() {
    const std::optional<std::int64_t> round = hyperperiod_of_offsets();
    const std::optional<std::int64_t> busy = longest_busy();
    if (!round || !busy || !few_candidates(*round, *busy)) return std::nullopt;
    std::int64_t longest = 0;
    const std::int64_t first = *task_.offset % task_.period;
    for (std::int64_t arrival = first; arrival < first + *round; arrival += task_.period)
      for (const std::int64_t start : starts(arrival, *busy)) {
        const auto end = end_of(start, arrival);
        if (!end) return std::nullopt;
        longest = std::max(longest, *end - arrival);
      }
    return longest;
  }

 private:
  std::optional<std::int64_t> hyperperiod_of_offsets() const {
    std::optional<std::int64_t> round = task_.period;
    for (const TaskTimes& other : higher_)
      if (other.offset && round) round = common_multiple(*round, other.period, kLongestRound);
    return round;
  }

  // Without a phase that is known, no busy period is longer.
  std::optional<std::int64_t> longest_busy() {
    std::vector<Source> sources{{task_.period, task_.jitter, task_.work}};
    for (const TaskTimes& other : higher_) sources.push_back({other.period, other.jitter, other.work});
    if (load_of(sources) != Load::kBelow) return std::nullopt;
    const auto busy = least_window(0, sources, 1, effort_);
    return busy && *busy <= kLongestRound ? busy : std::nullopt;
  }

  // For all arrivals together.
  bool few_candidates(std::int64_t round, std::int64_t busy) const {
    Int128 each = (Int128{busy} + task_.jitter) / task_.period + 2;
    for (const TaskTimes& other : higher_)
      if (other.offset) each += (Int128{busy} + task_.jitter) / other.period + 2;
    return each * (round / task_.period) <= kMostCandidates;
  }

  // The latest releases from which a busy period may reach the arrival's job.
  std::vector<std::int64_t> starts(std::int64_t arrival, std::int64_t busy) const {
    std::vector<std::int64_t> found;
    const std::int64_t from = arrival - busy, until = arrival + task_.jitter;
    const auto add = [&](const TaskTimes& task) {
      const std::int64_t latest = *task.offset % task.period + task.jitter;
      for (std::int64_t n = ceiling(from - latest, task.period); latest + n * task.period <= until; ++n)
        found.push_back(latest + n * task.period);
    };
    add(task_);
    for (const TaskTimes& other : higher_)
      if (other.offset) add(other);
    return found;
  }

  static std::int64_t jobs(const TaskTimes& task, std::int64_t start, std::int64_t end) {
    if (!task.offset) return ceiling(end - start + task.jitter, task.period);
    const std::int64_t offset = *task.offset % task.period;
    return std::max<std::int64_t>(
        0, ceiling(end - offset, task.period) - ceiling(start - task.jitter - offset, task.period));
  }

  std::optional<std::int64_t> end_of(std::int64_t start, std::int64_t arrival) {
    const std::int64_t own = jobs(task_, start, arrival + 1) * task_.work;
    for (std::int64_t end = start + 1;;) {
      effort_.left -= static_cast<std::int64_t>(higher_.size()) + 1;
      if (effort_.left < 0) return std::nullopt;
      std::int64_t next = start + own;
      for (const TaskTimes& other : higher_) next += jobs(other, start, end) * other.work;
      if (next <= end) return end;
      end = next;
    }
  }

  std::span<const TaskTimes> higher_;
  const TaskTimes& task_;
  Effort effort_{.left = 500'000};
};

}  // namespace

std::optional<std::int64_t> response_with_offsets(std::span<const TaskTimes> higher, const TaskTimes& task) {
  if (!task.offset || task.blocking > 0 || task.jitter > task.period) return std::nullopt;
  return OffsetAnalysis(higher, task).longest();
}

}  // namespace ttf::schedules::timing::response
