#include <algorithm>

#include "core/int128.h"
#include "schedules/timing/response/dynamic_parts.h"
#include "schedules/timing/response/recurrence.h"

namespace ttf::schedules::timing::response {
namespace {

// A message of a lower slot that shares cycles with the one in question.
struct Rival {
  int slot = 0;
  std::int64_t more = 0;   // minislots beyond those of a silent slot
  std::int64_t every = 1;  // it shares every so many of the other's own cycles
  std::int64_t period = 1, ahead = 0;
  CycleDelay delay;
};

class Covering {
 public:
  Covering(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot, std::size_t which,
           std::span<const CycleDelay> delays)
      : segment_(segment), message_(by_slot[which]), needed_(message_.latest_tx - message_.slot + 1) {
    // A decision at the turn comes up to a segment later than at its start.
    const bool at_start = segment.decision == DynamicSegment::Decision::kAtSegmentStart;
    const std::int64_t spread = at_start ? 0 : segment.minislots * segment.minislot;
    for (std::size_t j = 0; j < which; ++j) {
      const DynamicMessage& other = by_slot[j];
      if (other.slot == message_.slot || other.minislots == 1 || !share_cycles(other, message_)) continue;
      rivals_.push_back({other.slot, other.minislots - 1, std::max(1, other.repetition / message_.repetition),
                         other.period, other.jitter + spread, delays[j]});
    }
    // The longest frame of a slot comes first: a cycle has at most one of them.
    std::stable_sort(rivals_.begin(), rivals_.end(), [](const Rival& a, const Rival& b) {
      return a.slot != b.slot ? a.slot < b.slot : a.more > b.more;
    });
  }

  bool ever_sent() const { return needed_ > 0; }

  // Returns whether no cycle is ever lost.
  bool never_loses() const { return most_more(1, true) < needed_; }

  // Returns the most of `own` own cycles in a row that lower slots can take away.
  std::int64_t most_lost(std::int64_t own) const {
    count_frames(own);
    // most_more() is concave, so what can be lost is all up to a largest number.
    std::int64_t lost = 0, too_many = own + 1;
    while (too_many - lost > 1) {
      const std::int64_t middle = lost + (too_many - lost) / 2;
      (most_more(middle, false) >= static_cast<Int128>(middle) * needed_ ? lost : too_many) = middle;
    }
    return lost;
  }

  // Returns the latest minislot of a turn in time: the largest sum of one frame, or none, of each lower slot.
  std::int64_t latest_turn() const {
    std::vector<bool> reached(static_cast<std::size_t>(needed_), false);
    reached[0] = true;
    for (auto first = rivals_.begin(); first != rivals_.end();) {
      const auto next = std::find_if(first, rivals_.end(), [&](const Rival& one) { return one.slot != first->slot; });
      std::vector<bool> with = reached;
      for (auto rival = first; rival != next; ++rival)
        for (std::size_t sum = static_cast<std::size_t>(rival->more); sum < reached.size(); ++sum)
          if (reached[sum - static_cast<std::size_t>(rival->more)]) with[sum] = true;
      reached = std::move(with);
      first = next;
    }
    const auto last = std::find(reached.rbegin(), reached.rend(), true);
    return message_.slot + (reached.rend() - last) - 1;
  }

 private:
  // Sets the most frames of each rival in `own` own cycles in a row.
  void count_frames(std::int64_t own) const {
    frames_.clear();
    for (const Rival& rival : rivals_) {
      const std::int64_t shared = (own + rival.every - 1) / rival.every;
      if (!rival.delay) {
        frames_.push_back(shared);
        continue;
      }
      const std::int64_t cycles = (own - 1) * message_.repetition + 1 + *rival.delay;
      const Int128 arrivals = ceil_of(static_cast<Int128>(cycles) * segment_.cycle + rival.ahead, rival.period);
      frames_.push_back(static_cast<std::int64_t>(std::min<Int128>(shared, arrivals)));
    }
  }

  // Returns the most minislots that the rivals' frames, or any number of them, add to `cycles` cycles.
  Int128 most_more(std::int64_t cycles, bool any_number) const {
    Int128 sum = 0;
    std::int64_t left = cycles;
    for (std::size_t i = 0; i < rivals_.size(); ++i) {
      if (i == 0 || rivals_[i].slot != rivals_[i - 1].slot) left = cycles;
      const std::int64_t used = any_number ? left : std::min(left, frames_[i]);
      sum += static_cast<Int128>(used) * rivals_[i].more;
      left -= used;
    }
    return sum;
  }

  const DynamicSegment& segment_;
  const DynamicMessage& message_;
  std::int64_t needed_;
  std::vector<Rival> rivals_;                 // by slot
  mutable std::vector<std::int64_t> frames_;  // by rival, for the window of the last question
};

// Returns the fewest own cycles that have room for `instances` instances.
std::optional<std::int64_t> own_cycles(const Covering& covering, std::int64_t instances, std::int64_t from) {
  std::int64_t own = std::max(from, instances);
  while (own <= kMostOwnCycles) {
    const std::int64_t missing = instances - (own - covering.most_lost(own));
    if (missing <= 0) return own;
    own += missing;  // fewer cannot do: the lost cycles do not become fewer
  }
  return std::nullopt;
}

}  // namespace

DelayedResponse covering_bound(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot,
                               std::size_t which, std::span<const CycleDelay> delays) {
  const DynamicMessage& message = by_slot[which];
  const Covering covering(segment, by_slot, which, delays);
  const std::int64_t round = message.repetition * segment.cycle;
  if (!covering.ever_sent() || message.period < round) return {};
  // Every cycle is needed, so each lost one leaves another instance in the queue.
  if (message.period == round && !covering.never_loses()) return {};
  const std::int64_t turn = covering.latest_turn();
  DelayedResponse worst{{{Quality::kBound, 0}, 0, turn}, 0};
  std::int64_t own = 1;
  for (std::int64_t q = 0; q < kMostOwnCycles; ++q) {
    const auto cycles = own_cycles(covering, q + 1, own);
    if (!cycles) return {};
    own = *cycles;
    const Int128 queued = static_cast<Int128>(q) * message.period - message.jitter;
    const auto longest =
        static_cast<std::int64_t>(end_of_frame(segment, message, own, turn) - static_cast<Int128>(q) * message.period);
    worst.response.response.longest = std::max(worst.response.response.longest, longest);
    worst.response.lost_cycles = std::max(worst.response.lost_cycles, own - q - 1);
    const auto first_cycle = queued < 0 ? 1 : static_cast<std::int64_t>(queued / segment.cycle) + 1;
    worst.delay = std::max(*worst.delay, own * message.repetition - first_cycle);
    // Where no cycle is ever lost, the first instance waits the longest.
    if (covering.never_loses() || static_cast<Int128>(own) * round <= queued + message.period) return worst;
  }
  return {};
}

}  // namespace ttf::schedules::timing::response
