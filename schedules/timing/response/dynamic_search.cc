#include <algorithm>
#include <map>

#include "core/int128.h"
#include "schedules/timing/response/dynamic_parts.h"

namespace ttf::schedules::timing::response {
namespace {

// The lower slots before a cycle's arrivals. Arrivals come an instant behind whole numbers, so one before the
// segment's start is below zero.
struct SegmentState {
  std::vector<std::int64_t> waiting;  // frames, by message
  std::vector<std::int64_t> next;     // earliest next arrival, relative to the segment's start, by message
};

// Earlier arrivals allow all that later ones allow. So a state is dropped if another one has the same cycle, the same
// waiting frames, and arrivals no later.
class WorstStates {
 public:
  // The cycle within the longest repetition, and the waiting frames.
  using Key = std::pair<std::int64_t, std::vector<std::int64_t>>;

  // Returns whether the state is new: no other one has arrivals as early as its own.
  bool add(std::int64_t cycle, const SegmentState& state) {
    std::vector<std::vector<std::int64_t>>& all = by_key_[{cycle, state.waiting}];
    if (covered(all, state.next)) return false;
    const auto later =
        std::remove_if(all.begin(), all.end(), [&](const auto& one) { return no_later(state.next, one); });
    size_ -= static_cast<std::size_t>(all.end() - later);
    all.erase(later, all.end());
    all.push_back(state.next);
    ++size_;
    return true;
  }

  // Returns whether each state of `other` has one here that is as early.
  bool cover(const WorstStates& other) const {
    for (const auto& [key, nexts] : other.by_key_) {
      const auto here = by_key_.find(key);
      if (here == by_key_.end()) return false;
      for (const auto& next : nexts)
        if (!covered(here->second, next)) return false;
    }
    return true;
  }

  bool holds(std::int64_t cycle, const SegmentState& state) const {
    const auto here = by_key_.find({cycle, state.waiting});
    return here != by_key_.end() &&
           std::find(here->second.begin(), here->second.end(), state.next) != here->second.end();
  }

  template <class See> void each(See see) const {
    for (const auto& [key, nexts] : by_key_)
      for (const auto& next : nexts) see(key.first, SegmentState{key.second, next});
  }

  std::size_t size() const { return size_; }

 private:
  static bool no_later(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
      if (a[i] > b[i]) return false;
    return true;
  }
  static bool covered(const std::vector<std::vector<std::int64_t>>& all, const std::vector<std::int64_t>& next) {
    return std::any_of(all.begin(), all.end(), [&](const auto& one) { return no_later(one, next); });
  }

  std::map<Key, std::vector<std::vector<std::int64_t>>> by_key_;
  std::size_t size_ = 0;
};

class SegmentSearch {
 public:
  struct Worst {
    std::int64_t lost = 0, turn = 0;
    auto operator<=>(const Worst&) const = default;
  };
  enum class End : std::uint8_t { kFound, kStarved, kTooLarge };

  SegmentSearch(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot, std::size_t which)
      : segment_(segment), message_(by_slot[which]), rounds_(message_.repetition) {
    for (const DynamicMessage& other : by_slot.first(which)) {
      if (other.slot == message_.slot || other.minislots == 1) continue;
      lower_.push_back(other);
      rounds_ = std::max<std::int64_t>(rounds_, other.repetition);
    }
  }

  // Finds the most own cycles lost, and then the latest turn, of a message that came just too late for an own cycle.
  End run(Worst& worst) {
    WorstStates layer;
    if (!explore(layer)) return End::kTooLarge;
    WorstStates earlier = layer;  // a layer with the same cycles, to notice that there is no end
    for (std::int64_t cycles = 1, renewed = 1; layer.size() > 0; ++cycles) {
      WorstStates next;
      const std::int64_t lost = (cycles - 1) / message_.repetition;
      layer.each([&](std::int64_t cycle, const SegmentState& state) {
        ways(cycle, state, [&](const SegmentState& after, std::int64_t turn) {
          if (!sends_in(message_, cycle) || turn > message_.latest_tx)
            next.add((cycle + 1) % rounds_, after);
          else
            worst = std::max(worst, {lost, turn});
        });
      });
      if (effort_ > kMostWays || next.size() > kMostSearchedStates) return End::kTooLarge;
      if (next.size() > 0 && cycles % rounds_ == 0) {
        if (next.cover(earlier)) return End::kStarved;
        if (cycles / rounds_ == 2 * renewed) renewed *= 2, earlier = next;
      }
      layer = std::move(next);
    }
    return End::kFound;
  }

 private:
  static constexpr std::size_t kMostWays = 8 * kMostSearchedStates;

  // Finds all states that lower slots may be in, and those behind an own cycle. Returns false beyond
  // kMostSearchedStates.
  bool explore(WorstStates& missed) {
    WorstStates reached;
    std::vector<std::pair<std::int64_t, SegmentState>> open;
    for (std::int64_t cycle = 0; cycle < rounds_; ++cycle) {
      SegmentState quiet;
      for (const DynamicMessage& other : lower_) {
        quiet.waiting.push_back(0);
        quiet.next.push_back(-segment_.cycle - other.jitter);
      }
      reached.add(cycle, quiet);
      open.push_back({cycle, quiet});
    }
    while (!open.empty()) {
      const auto [cycle, state] = std::move(open.back());
      open.pop_back();
      if (!reached.holds(cycle, state)) continue;  // another one is worse by now
      const std::int64_t next_cycle = (cycle + 1) % rounds_;
      const bool own = sends_in(message_, cycle);
      ways(cycle, state, [&](const SegmentState& after, std::int64_t) {
        if (own) missed.add(next_cycle, after);
        if (reached.add(next_cycle, after)) open.push_back({next_cycle, after});
      });
      if (effort_ > kMostWays || reached.size() > kMostSearchedStates) return false;
    }
    return true;
  }

  // Calls `see` with the state behind each choice of arrivals, and the turn of the message's slot.
  template <class See> void ways(std::int64_t cycle, const SegmentState& state, See see) {
    SegmentState arrived = state;
    choose(cycle, arrived, 0, see);
  }

  template <class See> void choose(std::int64_t cycle, SegmentState& arrived, std::size_t at, See& see) {
    if (++effort_ > kMostWays) return;
    if (at == lower_.size()) {
      SegmentState after = arrived;
      const std::int64_t turn = send(cycle, after);
      see(after, turn);
      return;
    }
    const std::int64_t waiting = arrived.waiting[at], next = arrived.next[at];
    choose(cycle, arrived, at + 1, see);
    while (arrived.next[at] < 0 && effort_ <= kMostWays) {
      ++arrived.waiting[at];
      arrived.next[at] += lower_[at].period;
      choose(cycle, arrived, at + 1, see);
    }
    arrived.waiting[at] = waiting;
    arrived.next[at] = next;
  }

  // Sends what is in time, and returns the turn of the message's slot.
  std::int64_t send(std::int64_t cycle, SegmentState& state) const {
    std::int64_t more = 0;  // minislots beyond those of silent slots
    for (std::size_t i = 0; i < lower_.size(); ++i) {
      const DynamicMessage& other = lower_[i];
      if (state.waiting[i] > 0 && sends_in(other, cycle) && other.slot + more <= other.latest_tx) {
        --state.waiting[i];
        more += other.minislots - 1;
      }
      state.next[i] = std::max(state.next[i] - segment_.cycle, -segment_.cycle - other.jitter);
    }
    return message_.slot + more;
  }

  const DynamicSegment& segment_;
  const DynamicMessage& message_;
  std::vector<DynamicMessage> lower_;
  std::int64_t rounds_;  // cycles until the same messages may send
  std::size_t effort_ = 0;
};

}  // namespace

std::optional<DynamicResponse> searched_response(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot,
                                                 std::size_t which) {
  check_messages(segment, by_slot);
  const DynamicMessage& message = by_slot[which];
  if (segment.decision != DynamicSegment::Decision::kAtSegmentStart || message.slot > message.latest_tx)
    return std::nullopt;
  SegmentSearch::Worst worst;
  const SegmentSearch::End end = SegmentSearch(segment, by_slot, which).run(worst);
  if (end == SegmentSearch::End::kTooLarge) return std::nullopt;
  if (end == SegmentSearch::End::kStarved) return DynamicResponse{};
  const std::int64_t cycles = worst.lost + 1;
  if (static_cast<Int128>(cycles) * message.repetition * segment.cycle > message.period - message.jitter)
    return std::nullopt;
  return DynamicResponse{{Quality::kExact, end_of_frame(segment, message, cycles, worst.turn)}, worst.lost, worst.turn};
}

}  // namespace ttf::schedules::timing::response
