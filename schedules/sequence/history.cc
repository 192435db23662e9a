#include "schedules/sequence/history.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace ttf::schedules::sequence {

DetectionHistory::DetectionHistory(int sensors, Duration first_guess, std::size_t kept)
    : times_(static_cast<std::size_t>(sensors)), first_guess_(first_guess), kept_(kept) {
  TTF_CHECK(kept >= 1 && kept <= kMostKept, "{} kept times", kept);
}

void DetectionHistory::add(int sensor, Duration primary) {
  Times& times = times_.at(static_cast<std::size_t>(sensor));
  times.last[times.count++ % kept_] = primary;
}

Duration DetectionHistory::primary(int sensor) const {
  const Times& times = times_.at(static_cast<std::size_t>(sensor));
  const std::size_t kept = std::min(times.count, kept_);
  if (kept == 0) return first_guess_;
  Duration sum{};
  for (std::size_t i = 0; i < kept; ++i) sum += times.last[i];
  return Duration::nanoseconds(sum.ns / static_cast<std::int64_t>(kept));
}

Duration DetectionHistory::primaries() const {
  Duration sum{};
  for (std::size_t sensor = 0; sensor < times_.size(); ++sensor) sum += primary(static_cast<int>(sensor));
  return sum;
}

Duration DetectionHistory::secondary(double share) const {
  TTF_CHECK(share >= 0.0 && share <= 1.0 && !times_.empty(), "a share of {}", share);
  const double mean = static_cast<double>(primaries().ns) / static_cast<double>(times_.size());
  return Duration::nanoseconds(std::llround(share * mean));
}

Duration occupied(Duration detection, Duration step) {
  const std::int64_t steps = (detection.ns + step.ns - 1) / step.ns;
  return step * std::max<std::int64_t>(steps, 2);
}

}  // namespace ttf::schedules::sequence
