#include "evaluation/lateness/achieved_precision.h"

#include <algorithm>

#include "core/int128.h"

namespace ttf::evaluation::lateness {
namespace {

constexpr Duration kLongestCycle = Duration::milliseconds(16);  // cCycleMax
constexpr std::int64_t kGapCycles = 5;                          // a missing stamp leaves a gap of four, two of six

// Within 36 years of the drive's start: other times, from damaged logs, could overflow.
bool possible(std::int64_t ns) {
  constexpr std::int64_t kFarthest_ns = std::int64_t{1} << 60;
  return ns >= -kFarthest_ns && ns <= kFarthest_ns;
}

}  // namespace

AchievedPrecision::AchievedPrecision(Duration cycle, int cycles) {
  if (cycle <= Duration{} || cycle > kLongestCycle) return;
  round_ns_ = (cycle * cycles).ns;
  longest_gap_ = cycle * kGapCycles;
}

// Wraps into half a round to either side.
std::int64_t AchievedPrecision::within_round(std::int64_t ns) const {
  const std::int64_t rest = ns % round_ns_;
  if (rest >= round_ns_ / 2) return rest - round_ns_;
  return rest < -round_ns_ / 2 ? rest + round_ns_ : rest;
}

void AchievedPrecision::add(const recording::records::Stamp& stamp) {
  const bool by_the_cluster = stamp.global.ns != stamp.local.ns;  // else it has no global time (records::Stamp)
  if (round_ns_ == 0 || !by_the_cluster || !possible(stamp.true_time.ns) || !possible(stamp.global.ns)) return;
  std::deque<Offset>& own = offsets_[stamp.node];
  if (!own.empty() && stamp.true_time <= own.back().at) return;
  own.push_back({stamp.true_time, within_round(stamp.global.ns - stamp.true_time.ns)});
  instants_.push_back(stamp.true_time);
  while (instants_.front() + longest_gap_ < stamp.true_time) {
    compare(instants_.front());
    instants_.pop_front();
  }
}

void AchievedPrecision::compare(TrueTime at) {
  std::int64_t first = 0, lowest = 0, highest = 0;
  int nodes = 0;
  for (auto& [node, offsets] : offsets_) {
    while (offsets.size() > 1 && offsets[1].at <= at) offsets.pop_front();
    if (offsets.empty() || offsets.front().at > at) continue;
    std::int64_t shown = offsets.front().ns;
    if (offsets.front().at < at) {
      if (offsets.size() < 2 || offsets[1].at - offsets[0].at > longest_gap_) continue;
      const std::int64_t change = within_round(offsets[1].ns - offsets[0].ns);
      shown += static_cast<std::int64_t>(Int128{change} * (at - offsets[0].at).ns / (offsets[1].at - offsets[0].at).ns);
    }
    if (nodes++ == 0) first = shown;
    const std::int64_t apart = within_round(shown - first);
    lowest = std::min(lowest, apart);
    highest = std::max(highest, apart);
  }
  if (nodes > 1) apart_.add(Duration{highest - lowest});
}

recording::records::BinnedDurations AchievedPrecision::finish() {
  for (const TrueTime at : instants_) compare(at);
  instants_.clear();
  return apart_;
}

}  // namespace ttf::evaluation::lateness
