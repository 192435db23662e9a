#include <algorithm>
#include <map>

#include "schedules/timing/response/dynamic_parts.h"

namespace ttf::schedules::timing::response {
namespace {

constexpr std::size_t kMostWays = 8 * kMostSearchedStates;

// The lower slots before a cycle's arrivals: the cycle's number within the longest repetition, then for each message
// the frames that wait, and the earliest next arrival relative to the segment's start. Arrivals come an instant
// behind whole numbers, so one before the start is below zero.
using SegmentState = std::vector<std::int64_t>;

// One cycle's way to the next: whether the message in question gets its turn in it, and where.
struct SegmentWay {
  std::size_t next = 0;
  std::int64_t turn = 0;  // minislot of the message's slot
};

class SegmentSearch {
 public:
  SegmentSearch(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot, std::size_t which)
      : segment_(segment), message_(by_slot[which]) {
    for (const DynamicMessage& other : by_slot.first(which))
      if (other.slot < message_.slot && other.minislots > 1) lower_.push_back(other);
    for (const DynamicMessage& other : lower_) rounds_ = std::max<std::int64_t>(rounds_, other.repetition);
    rounds_ = std::max<std::int64_t>(rounds_, message_.repetition);
  }

  // Returns false beyond kMostSearchedStates.
  bool explore() {
    for (std::int64_t cycle = 0; cycle < rounds_; ++cycle) {
      SegmentState quiet{cycle};
      for (const DynamicMessage& other : lower_) {
        quiet.push_back(0);
        quiet.push_back(-segment_.cycle - other.jitter);
      }
      place_of(quiet);
    }
    for (std::size_t at = 0; at < states_.size(); ++at) {
      first_way_.push_back(ways_.size());
      add_ways(SegmentState(*states_[at]), 0);
      if (states_.size() > kMostSearchedStates || ways_.size() > kMostWays) return false;
    }
    first_way_.push_back(ways_.size());
    return true;
  }

  struct Worst {
    std::int64_t lost = -1, turn = 0;
    auto operator<=>(const Worst&) const = default;
  };

  // Returns the most own cycles lost, and then the latest turn, of a message that came just too late for an own
  // cycle. Returns nullopt if it may never get its turn.
  std::optional<Worst> longest_wait() {
    worst_.assign(states_.size(), {});
    mark_.assign(states_.size(), Mark::kNew);
    Worst longest;
    for (std::size_t at = 0; at < states_.size(); ++at) {
      if (!sends_in(message_, (*states_[at])[0])) continue;
      for (std::size_t way = first_way_[at]; way < first_way_[at + 1]; ++way) {
        if (!settle(ways_[way].next)) return std::nullopt;
        longest = std::max(longest, worst_[ways_[way].next]);
      }
    }
    return longest;
  }

 private:
  enum class Mark : std::uint8_t { kNew, kOpen, kSettled };

  std::size_t place_of(const SegmentState& state) {
    const auto [entry, fresh] = places_.try_emplace(state, states_.size());
    if (fresh) states_.push_back(&entry->first);
    return entry->second;
  }

  // Adds each choice of arrivals, from message `at` on.
  void add_ways(const SegmentState& state, std::size_t at) {
    if (ways_.size() > kMostWays) return;
    if (at == lower_.size()) return send(state);
    add_ways(state, at + 1);
    SegmentState more = state;
    while (more[2 + 2 * at] < 0 && ways_.size() <= kMostWays) {
      ++more[1 + 2 * at];
      more[2 + 2 * at] += lower_[at].period;
      add_ways(more, at + 1);
    }
  }

  void send(SegmentState state) {
    std::int64_t more = 0;  // minislots beyond those of silent slots
    for (std::size_t i = 0; i < lower_.size(); ++i) {
      const DynamicMessage& other = lower_[i];
      std::int64_t &waiting = state[1 + 2 * i], &next = state[2 + 2 * i];
      if (waiting > 0 && sends_in(other, state[0]) && other.slot + more <= other.latest_tx) {
        --waiting;
        more += other.minislots - 1;
      }
      next = std::max(next - segment_.cycle, -segment_.cycle - other.jitter);
    }
    state[0] = (state[0] + 1) % rounds_;
    ways_.push_back({place_of(state), message_.slot + more});
  }

  struct Open {
    std::size_t state = 0, way = 0;
  };

  // Finds the worst of a state in which the message waits, depth first. Returns false if a round of states never
  // sends it.
  bool settle(std::size_t start) {
    std::vector<Open> open;
    if (mark_[start] == Mark::kNew) open.push_back(begin(start));
    while (!open.empty()) {
      Open& top = open.back();
      if (top.way == first_way_[top.state + 1]) {
        mark_[top.state] = Mark::kSettled;
        open.pop_back();
        continue;
      }
      const SegmentWay& way = ways_[top.way];
      const bool own = sends_in(message_, (*states_[top.state])[0]);
      Worst& worst = worst_[top.state];
      if (own && way.turn <= message_.latest_tx) {
        worst = std::max(worst, {0, way.turn});
      } else if (mark_[way.next] == Mark::kSettled) {
        const Worst& next = worst_[way.next];
        worst = std::max(worst, {next.lost + (own ? 1 : 0), next.turn});
      } else if (mark_[way.next] == Mark::kOpen) {
        return false;
      } else {
        open.push_back(begin(way.next));  // comes back to this way when the next state is settled
        continue;
      }
      ++top.way;
    }
    return true;
  }

  Open begin(std::size_t state) {
    mark_[state] = Mark::kOpen;
    return {state, first_way_[state]};
  }

  const DynamicSegment& segment_;
  const DynamicMessage& message_;
  std::vector<DynamicMessage> lower_;
  std::int64_t rounds_ = 1;
  std::map<SegmentState, std::size_t> places_;
  std::vector<const SegmentState*> states_;
  std::vector<SegmentWay> ways_;        // by state
  std::vector<std::size_t> first_way_;  // by state
  std::vector<Worst> worst_;
  std::vector<Mark> mark_;
};

}  // namespace

std::optional<DynamicResponse> searched_response(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot,
                                                 std::size_t which) {
  check_messages(segment, by_slot);
  const DynamicMessage& message = by_slot[which];
  if (segment.decision != DynamicSegment::Decision::kAtSegmentStart || message.slot > message.latest_tx)
    return std::nullopt;
  SegmentSearch search(segment, by_slot, which);
  if (!search.explore()) return std::nullopt;
  const auto worst = search.longest_wait();
  if (!worst) return DynamicResponse{};
  const std::int64_t cycles = worst->lost + 1;
  if (cycles * message.repetition * segment.cycle > message.period - message.jitter) return std::nullopt;
  return DynamicResponse{
      {Quality::kExact, end_of_frame(segment, message, cycles, worst->turn)}, worst->lost, worst->turn};
}

}  // namespace ttf::schedules::timing::response
