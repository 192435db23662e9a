#include "schedules/synthesis/instants/order.h"

#include <numeric>

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

}  // namespace ttf::schedules::synthesis::instants
