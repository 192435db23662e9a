#include "schedules/synthesis/instants/order.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "schedules/synthesis/instants/ages.h"
#include "schedules/synthesis/instants/grid.h"

namespace ttf::schedules::synthesis::instants {
namespace {

// Returns the latest beginning of a's measurement that is in order with the lists of b.
Ticks latest_before(const Reading& reading, const Fused& a, const Fused& b, const std::vector<Ticks>& at) {
  const std::vector<Activity>& activities = reading.problem.activities;
  const Ticks common = std::gcd(activities[a.measuring].period, activities[b.measuring].period);
  // From b's fusion to its next one behind that of a.
  const Ticks apart = at[a.fusing] - at[b.fusing];
  const Ticks next = apart - modulo(apart, common) + common;
  return at[b.measuring] + next - reading.order;
}

// Returns the part of a chain up to an activity; none if it is not on its way from `first`.
std::optional<Chain> part_of(const Chain& chain, std::size_t first, std::size_t last) {
  const auto end = std::find(chain.activities.begin(), chain.activities.end(), last);
  if (chain.activities.front() != first || end == chain.activities.end()) return std::nullopt;
  Chain part;
  part.activities.assign(chain.activities.begin(), end + 1);
  part.gaps.assign(chain.gaps.begin(), chain.gaps.begin() + (end - chain.activities.begin()));
  return part;
}

// Counts the beginnings of measurements and fusions in one count of ticks over all rounds. Returns false if no chain
// says how.
bool unwrap(const Reading& reading, std::vector<Ticks>& at) {
  for (const Fused& one : reading.fused) {
    bool known = false;
    for (const Chain& chain : reading.problem.chains) {
      const auto part = part_of(chain, one.measuring, one.fusing);
      if (!part) continue;
      const Ticks age = read_at(reading.problem, *part, at, at[one.measuring]) - at[one.measuring];
      at[one.measuring] = at[one.fusing] - age;
      known = true;
      break;
    }
    if (!known) return false;
  }
  return true;
}

// Returns what takes an activity's data, and how long behind its end.
std::set<std::pair<std::size_t, Ticks>> behind_end(const Reading& reading, const Graph& graph,
                                                   const std::vector<bool>& main, std::size_t a) {
  std::set<std::pair<std::size_t, Ticks>> found;
  for (const Edge& edge : graph.after[a])
    if (main[edge.other]) found.insert({edge.other, edge.gap - reading.problem.activities[a].duration});
  return found;
}

// Whether only other fusions and its own successors may be in a fusion's way.
bool shares_with_fusions_alone(const Reading& reading, const Graph& graph, const std::vector<bool>& main,
                               std::size_t fusing) {
  const std::vector<Activity>& all = reading.problem.activities;
  for (std::size_t b = 0; b < all.size(); ++b) {
    const bool fuses =
        std::any_of(reading.fused.begin(), reading.fused.end(), [&](const Fused& other) { return other.fusing == b; });
    if (all[b].resource != all[fusing].resource || fuses) continue;
    if (main[b] ? !graph.leads(fusing, b) : all[b].fixed.has_value()) return false;
  }
  return true;
}

}  // namespace

bool measure_in_order(const Reading& reading, const std::vector<bool>& placed, std::vector<Ticks>& at) {
  const std::vector<Fused>& fused = reading.fused;
  const auto stands = [&](const Fused& one) { return placed[one.fusing] && placed[one.measuring]; };
  // Each round settles at least one measurement for good.
  for (std::size_t round = 0; round <= fused.size(); ++round) {
    bool changed = false;
    for (const Fused& a : fused)
      for (const Fused& b : fused) {
        if (a.node != b.node || a.fusing == b.fusing || !stands(a) || !stands(b)) continue;
        const Ticks latest = latest_before(reading, a, b, at);
        if (at[a.measuring] <= latest) continue;
        if (reading.problem.activities[a.measuring].fixed) return false;
        at[a.measuring] = latest;
        changed = true;
      }
    if (!changed) return true;
  }
  return false;
}

std::optional<bool> fused_in_order(const Reading& reading, const std::vector<Ticks>& offsets) {
  if (reading.fused.size() < 2) return true;
  std::vector<Ticks> at = offsets;
  if (!unwrap(reading, at)) return std::nullopt;
  const std::vector<Ticks> before = at;
  return measure_in_order(reading, std::vector<bool>(at.size(), true), at) && at == before;
}

bool all_orders_agree(const Reading& reading, const Graph& graph, const std::vector<bool>& main) {
  const std::vector<Activity>& all = reading.problem.activities;
  for (const Fused& a : reading.fused)
    for (const Fused& b : reading.fused) {
      if (a.node != b.node || a.fusing == b.fusing) continue;
      if (all[a.fusing].fixed || all[b.fusing].fixed) return false;
      if (!shares_with_fusions_alone(reading, graph, main, a.fusing)) return false;
      if (behind_end(reading, graph, main, a.fusing) != behind_end(reading, graph, main, b.fusing)) return false;
    }
  return true;
}

}  // namespace ttf::schedules::synthesis::instants
