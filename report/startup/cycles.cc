#include "report/startup/cycles.h"

#include <algorithm>

#include "recording/records/records.h"
#include "report/drawing/log_limits.h"

namespace ttf::report::startup {
namespace {

using recording::records::PocKind;
using recording::records::Symbol;

// Returns the end of the node's last symbol that ended before `before`.
std::optional<TrueTime> last_cas(const StartupData& data, std::optional<NodeId> node, TrueTime before) {
  std::optional<TrueTime> end;
  for (const auto& s : data.symbols)
    if (s.kind == Symbol::kCas && (!node || s.stamp.node == *node) && s.end.true_time <= before)
      end = end ? std::max(*end, s.end.true_time) : s.end.true_time;
  return end;
}

}  // namespace

std::optional<LeadingNode> leading_node(const StartupData& data) {
  for (const auto& c : data.changes)
    if (c.from == PocKind::kColdstartConsistencyCheck && c.to == PocKind::kNormalActive)
      if (const auto cas = last_cas(data, c.node, c.at)) return LeadingNode{c.node, *cas};
  std::optional<LeadingNode> last;
  for (const auto& s : data.symbols)
    if (s.kind == Symbol::kCas && (!last || s.end.true_time > last->cas))
      last = LeadingNode{s.stamp.node, s.end.true_time};
  return last;
}

std::map<std::int64_t, TrueTime> cycles_of(const StartupData& data, const LeadingNode& leader, Duration cycle,
                                           TrueTime end) {
  std::map<std::int64_t, TrueTime> starts;
  if (cycle.ns <= 0 || end < leader.cas || (end - leader.cas).ns / cycle.ns > drawing::kMostCycleLines) return starts;
  // The leader's frames in the slot of its first frame, the key slot.
  std::map<std::int64_t, TrueTime> sent;
  std::optional<std::uint16_t> key_slot;
  for (const auto& f : data.frames) {
    if (f.node != leader.node || f.start < leader.cas) continue;
    if (!key_slot) {
      if (f.cycle != 0) break;
      key_slot = f.slot;
    }
    if (f.slot == *key_slot) sent.try_emplace(f.cycle, f.start);
  }
  const Duration place = sent.empty() ? Duration{} : sent.begin()->second - leader.cas;
  const Duration half{cycle.ns / 2};
  TrueTime at = leader.cas;
  for (std::int64_t c = 0; at <= end; ++c, at += cycle) {
    // A frame half a cycle off its place belongs to another schedule: the node began anew.
    if (const auto k = sent.find(c); k != sent.end()) {
      const TrueTime by_frame = k->second - place;
      if (by_frame - at < half && at - by_frame < half) at = by_frame;
    }
    starts[c] = at;
  }
  return starts;
}

}  // namespace ttf::report::startup
