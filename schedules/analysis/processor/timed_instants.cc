#include "schedules/analysis/processor/timed_instants.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "core/int128.h"
#include "schedules/model/round.h"

namespace ttf::schedules::analysis::processor {

std::int64_t ClockCorrections::shortest(std::int64_t global_ns) const {
  if (global_ns == 0) return 0;
  const std::int64_t by_rate = static_cast<std::int64_t>(static_cast<Int128>(global_ns) * rate / microticks) + 1;
  const std::int64_t by_offset = offset_ns * (global_ns / (2 * cycle_ns) + 1);
  return std::max<std::int64_t>(0, global_ns - by_rate - by_offset - model::kGranularity_ns);
}

TimedInstants::TimedInstants(std::vector<Instant> instants, std::int64_t round_ns,
                             std::optional<ClockCorrections> corrections)
    : instants_(std::move(instants)), round_ns_(round_ns), corrections_(corrections) {
  std::sort(instants_.begin(), instants_.end());
}

std::int64_t TimedInstants::shortest(std::int64_t global_ns) const {
  return corrections_ ? corrections_->shortest(global_ns) : global_ns;
}

bool TimedInstants::can_be_counted_on() const { return shortest(round_ns_) >= round_ns_ / 2; }

TimedInstants::Instant TimedInstants::numbered(std::int64_t number) const {
  const auto count = static_cast<std::int64_t>(instants_.size());
  std::int64_t round = number / count, place = number % count;
  if (place < 0) {
    --round;
    place += count;
  }
  Instant instant = instants_[static_cast<std::size_t>(place)];
  instant.at += round * round_ns_;
  return instant;
}

std::vector<TimedInstants::Neighbour> TimedInstants::within(std::size_t instant, std::int64_t most,
                                                            Direction direction) const {
  std::vector<Neighbour> neighbours;
  for (auto number = static_cast<std::int64_t>(instant);; number += direction == kForward ? 1 : -1) {
    const Instant other = numbered(number);
    const std::int64_t distance = shortest(std::abs(other.at - instants_[instant].at));
    if (distance > most) return neighbours;
    neighbours.push_back({distance, other.chain});
  }
}

}  // namespace ttf::schedules::analysis::processor
