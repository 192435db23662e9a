#include "schedules/synthesis/instants/objectives/optimiser.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "schedules/synthesis/instants/bounds.h"

namespace ttf::schedules::synthesis::instants::objectives {

using plan::Goal;
namespace {

constexpr Ticks kNoSlots = std::numeric_limits<Ticks>::max();

}  // namespace

void Optimiser::slots() {
  Ticks best = kNoSlots, bound = kNoSlots, least = kNoSlots;
  std::map<std::size_t, Ticks> by_trial;
  std::map<std::size_t, Ticks> unproven;  // their bounds
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    Trial& trial = trials_[i];
    if (trial.out) continue;
    const auto read = read_of(plan_, trial);
    trial.out = !read;
    if (trial.out) continue;
    least = std::min(least, least_slots(*read));
    const auto [few, proven_few] = fewest(*read, trial);
    if (!proven_few) unproven[i] = least_slots(*read);
    trial.out = !few;
    if (!few) continue;
    by_trial[i] = *few;
    best = std::min(best, *few);
  }
  for (const auto& [i, few] : by_trial) trials_[i].out = few > best;
  if (best > least && way_ == "bound") way_ = "all orders tried";
  for (const auto& [i, few] : unproven) bound = std::min(bound, few);
  bound = std::min(bound, best);
  note(Goal::kSlots, static_cast<double>(best), static_cast<double>(bound));
  for (const auto& [i, few] : unproven)
    if (trials_[i].out && few <= best) doubtful_.insert(i);
}

std::pair<std::optional<Ticks>, bool> Optimiser::fewest(const Read& read, Trial& trial) {
  bool proven = true;
  if (!trial.placed) {
    const Search found = place(read.reading, trial.limits, true);
    exact_ = exact_ && (found.exact || found.best);
    if (!found.best) return {std::nullopt, found.exact};
    trial.placed = found.best;
  }
  const Ticks slot = read.timed.cluster.flexray.gdStaticSlot;
  Ticks low = least_slots(read), high = last_slot_of(read, trial.placed->solution);
  while (low < high) {
    Limits limits = trial.limits;
    const Ticks middle = low + (high - low) / 2;
    limits.last_slot = middle * slot;
    const Search found = place(read.reading, limits, true);
    if (!found.best) {
      proven = proven && found.exact;
      low = middle + 1;
      continue;
    }
    trial.placed = found.best;
    high = std::min(middle, last_slot_of(read, found.best->solution));
  }
  trial.limits.last_slot = high * slot;
  return {high, proven};
}

}  // namespace ttf::schedules::synthesis::instants::objectives
