#include "report/timing/cycles.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "report/drawing/log_limits.h"

namespace ttf::report::timing {
namespace {

std::int64_t rounded(std::int64_t a, std::int64_t b) {
  const std::int64_t shifted = a + b / 2;
  return shifted / b - (shifted % b < 0 ? 1 : 0);
}

// The statement of one frame: a cycle of its sender's count began at `start`.
struct Statement {
  std::int64_t cycle;
  TrueTime start;
  std::int64_t count;       // the sender's count at the window's begin
  std::int64_t rounds = 0;  // how far `count` is ahead of the count of most frames
};

// Returns the statements in the order of the records.
std::vector<Statement> statements_of(const TimingData& data, Duration cycle, int cycles, TrueTime from) {
  std::vector<Statement> all;
  std::map<std::int64_t, std::size_t> frames;  // by count
  for (const auto& f : data.slot_frames) {
    if (!f.by_the_cluster) continue;
    const TrueTime start = f.start - Duration{f.global.ns - f.cycle * cycle.ns};
    all.push_back({f.cycle, start, f.cycle - rounded((start - from).ns, cycle.ns)});
    ++frames[all.back().count];
  }
  if (all.empty()) return all;
  const auto usual =
      std::max_element(frames.begin(), frames.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  // Within a window clocks drift by far less than a cycle: a difference of whole rounds comes from the counts.
  for (Statement& one : all) one.rounds = rounded(one.count - usual->first, cycles);
  return all;
}

// Returns the oldest count that has the most cycles, or at least two.
std::int64_t oldest_count(const std::vector<Statement>& all) {
  std::map<std::int64_t, std::set<std::int64_t>> cycles;
  std::size_t most = 0;
  for (const Statement& one : all) {
    auto& of_count = cycles[one.rounds];
    of_count.insert(one.cycle);
    most = std::max(most, of_count.size());
  }
  std::int64_t oldest = cycles.begin()->first;
  for (const auto& [rounds, numbers] : cycles)
    if (numbers.size() >= std::min<std::size_t>(most, 2)) oldest = rounds;
  return oldest;
}

}  // namespace

std::map<std::int64_t, TrueTime> cycle_starts(const TimingData& data, Duration cycle, int cycles, TrueTime from,
                                              TrueTime to) {
  std::map<std::int64_t, TrueTime> known, all;
  if (cycle.ns <= 0 || (to - from).ns / cycle.ns > drawing::kMostCycleLines) return all;
  const std::vector<Statement> statements = statements_of(data, cycle, cycles, from);
  if (!statements.empty()) {
    const std::int64_t oldest = oldest_count(statements);
    // Frames of the same count come first: a frame of another count may be a mistake.
    for (const bool same : {true, false})
      for (const Statement& one : statements)
        if ((one.rounds == oldest) == same) known.try_emplace(one.cycle + (oldest - one.rounds) * cycles, one.start);
  }
  const auto [number, start] =
      known.empty() ? std::pair<std::int64_t, TrueTime>{} : std::pair<std::int64_t, TrueTime>(*known.begin());
  const Duration half{cycle.ns / 2};
  const std::int64_t before = (start - from).ns / cycle.ns + 1;
  TrueTime at = start - cycle * before;
  for (std::int64_t c = number - before; at <= to + cycle; ++c, at += cycle) {
    // A frame half a cycle off its place does not show where the cycle began.
    if (const auto k = known.find(c); k != known.end() && (k->second - at < half && at - k->second < half))
      at = k->second;
    all[c] = at;
  }
  return all;
}

}  // namespace ttf::report::timing
