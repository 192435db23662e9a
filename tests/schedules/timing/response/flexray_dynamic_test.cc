// FlexRay's dynamic segment: by hand, against all arrivals of small sets, and against segments that run.
#include "schedules/timing/response/flexray_dynamic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/random.h"

namespace ttf::schedules::timing::response {
namespace {

using Decision = DynamicSegment::Decision;

constexpr std::int64_t kCycle = 1'000;

// 40 minislots of 10 at the end of a cycle of 1000.
DynamicSegment small_segment(Decision decision = Decision::kAtSegmentStart) {
  return {.cycle = kCycle, .minislot = 10, .minislots = 40, .decision = decision};
}

// A message that fills `minislots`, once in `cycles` cycles at most.
DynamicMessage once_in(int slot, std::int64_t minislots, std::int64_t cycles, std::int64_t latest_tx) {
  return {.slot = slot,
          .base_cycle = 0,
          .repetition = 1,
          .minislots = minislots,
          .latest_tx = latest_tx,
          .period = cycles * kCycle,
          .jitter = 0};
}

TEST(DynamicSegments, ALoneMessageWaitsForOneCycle) {
  const std::vector<DynamicMessage> one{once_in(3, 5, 4, 36)};
  const DynamicResponse response = dynamic_responses(small_segment(), one)[0];
  EXPECT_EQ(response.response, (Response{Quality::kExact, kCycle + (3 - 1 + 5) * 10}));
  EXPECT_EQ(response.lost_cycles, 0);
  EXPECT_EQ(response.latest_turn, 3);
  // Its turn always has the same place, so it waits from turn to turn.
  const DynamicResponse at_turn = dynamic_responses(small_segment(Decision::kAtTurn), one)[0];
  EXPECT_EQ(at_turn.response, (Response{Quality::kBound, kCycle + 5 * 10}));
}

// A rival of 30 minislots in every second cycle takes the turn away once: 1 + 29 + 1 = 31 > 30.
//
//   cycle    0      1        2
//   slot 1          |==30==| .
//   slot 2   ^late  lost     |==11==|
TEST(DynamicSegments, ARivalTakesOneCycleAway) {
  const std::vector<DynamicMessage> set{once_in(1, 30, 2, 11), once_in(2, 11, 8, 30)};
  const DynamicResponse response = dynamic_responses(small_segment(), set)[1];
  EXPECT_EQ(response.response, (Response{Quality::kExact, 2 * kCycle + (2 - 1 + 11) * 10}));
  EXPECT_EQ(response.lost_cycles, 1);
  // One minislot more of pLatestTx, and the turn comes behind the rival in the same cycle.
  const std::vector<DynamicMessage> fits{set[0], once_in(2, 10, 8, 31)};
  EXPECT_EQ(dynamic_responses(small_segment(), fits)[1].response,
            (Response{Quality::kExact, kCycle + (31 - 1 + 10) * 10}));
}

TEST(DynamicSegments, ARivalOfEveryCycleStarvesLowerSlots) {
  const std::vector<DynamicMessage> set{once_in(1, 30, 1, 11), once_in(2, 11, 8, 30)};
  EXPECT_EQ(dynamic_responses(small_segment(), set)[1].response, Response{});
  EXPECT_EQ(covering_bounds(small_segment(), set)[1].response, Response{});
  // In cycles of its own the message does not meet the rival.
  std::vector<DynamicMessage> apart = set;
  apart[0].repetition = apart[1].repetition = 2;
  apart[0].period = 2 * kCycle;
  apart[1].base_cycle = 1;
  EXPECT_EQ(dynamic_responses(small_segment(), apart)[1].response, (Response{Quality::kExact, 2 * kCycle + 12 * 10}));
}

// Slot multiplexing: two rivals share slot 1 in turns, so the long one meets the message in every second cycle at most.
TEST(DynamicSegments, RivalsOfOneSlotTakeTurns) {
  std::vector<DynamicMessage> set{once_in(1, 30, 2, 11), once_in(1, 5, 2, 11), once_in(2, 11, 8, 30)};
  set[0].repetition = set[1].repetition = 2;
  set[1].base_cycle = 1;
  const DynamicResponse response = dynamic_responses(small_segment(), set)[2];
  EXPECT_EQ(response.response, (Response{Quality::kExact, 2 * kCycle + (6 - 1 + 11) * 10}));
  EXPECT_EQ(covering_bounds(small_segment(), set)[2].lost_cycles, 1);
  set[1].minislots = 30;
  EXPECT_EQ(dynamic_responses(small_segment(), set)[2].response, Response{}) << "one of them is always there";
}

TEST(DynamicSegments, FramesThatAreTooLateOrTooMany) {
  EXPECT_EQ(dynamic_responses(small_segment(), std::vector<DynamicMessage>{once_in(9, 5, 4, 8)})[0].response,
            Response{})
      << "its turn is behind pLatestTx at best";
  std::vector<DynamicMessage> often{once_in(1, 5, 1, 36)};
  often[0].period = kCycle - 1;
  EXPECT_EQ(dynamic_responses(small_segment(), often)[0].response, Response{});
  // In each cycle, with jitter: two may wait at once, and both have a bound.
  often[0].period = kCycle;
  often[0].jitter = 300;
  EXPECT_EQ(dynamic_responses(small_segment(), often)[0].response, (Response{Quality::kBound, 300 + kCycle + 5 * 10}));
}

// Each of three rivals takes 9 minislots more. 10 of them take the turn away. By minislots two cycles could be lost,
// as 27 >= 2 * 10. But each needs two whole frames.
TEST(DynamicSegments, TheSearchSeesThatFramesAreWhole) {
  const std::vector<DynamicMessage> set{once_in(1, 10, 50, 31), once_in(2, 10, 50, 31), once_in(3, 10, 50, 31),
                                        once_in(4, 27, 50, 13)};
  EXPECT_EQ(covering_bounds(small_segment(), set)[3].lost_cycles, 2);
  EXPECT_EQ(dynamic_responses(small_segment(), set)[3].lost_cycles, 1);
  EXPECT_EQ(dynamic_responses(small_segment(), set)[3].response.quality, Quality::kExact);
}

TEST(DynamicSegments, LatestTxIsTheSpecifications) {
  EXPECT_EQ(latest_tx(small_segment(), 11), 30);
  EXPECT_EQ(latest_tx(small_segment(), 41), 0);
}

// Sends one cycle: frames that wait, by message, in slot order. Returns the minislot of the turn of slot `slot`.
std::int64_t send_cycle(const std::vector<DynamicMessage>& set, std::vector<std::int64_t>& waiting, std::int64_t cycle,
                        int slot) {
  std::int64_t turn = 1;
  int counted = 1;
  for (std::size_t i = 0; i < set.size() && set[i].slot < slot; ++i) {
    turn += set[i].slot - counted;
    counted = set[i].slot;
    if (waiting[i] == 0 || cycle % set[i].repetition != set[i].base_cycle || turn > set[i].latest_tx) continue;
    --waiting[i];
    turn += set[i].minislots;
    ++counted;
  }
  return turn + slot - counted;
}

// Tries all arrivals over some cycles, depth first, without theory. The message in question comes just too late for
// an own cycle. Each rival comes once in a cycle at most.
class AllArrivals {
 public:
  AllArrivals(const std::vector<DynamicMessage>& set, std::int64_t cycles) : set_(set), cycles_(cycles) {}

  std::int64_t most_lost() {
    for (std::int64_t phase = 0; phase < 2; ++phase)
      try_cycle(phase, phase + cycles_, std::vector<std::int64_t>(set_.size(), 0),
                std::vector<std::vector<std::int64_t>>(set_.size()), -1);
    return most_;
  }

 private:
  // Arrivals m and k of a rival are at least (m - k) T - J apart. Each lies in the cycle before the one that can take
  // it.
  static bool may_come(const DynamicMessage& rival, const std::vector<std::int64_t>& before, std::int64_t cycle) {
    for (std::size_t k = 0; k < before.size(); ++k) {
      const auto apart = static_cast<std::int64_t>(before.size() - k) * rival.period - rival.jitter;
      if (apart >= (cycle - before[k] + 1) * kCycle) return false;
    }
    return true;
  }

  // `lost` is -1 as long as the message in question does not wait.
  void try_cycle(std::int64_t cycle, std::int64_t end, const std::vector<std::int64_t>& waiting,
                 const std::vector<std::vector<std::int64_t>>& before, std::int64_t lost) {
    if (cycle == end) return;
    const std::size_t rivals = set_.size() - 1;
    for (std::uint32_t come = 0; come < (1U << rivals); ++come) {
      std::vector<std::int64_t> now = waiting;
      std::vector<std::vector<std::int64_t>> history = before;
      bool allowed = true;
      for (std::size_t i = 0; i < rivals; ++i) {
        if ((come >> i & 1U) == 0) continue;
        allowed = allowed && may_come(set_[i], before[i], cycle);
        history[i].push_back(cycle);
        ++now[i];
      }
      if (!allowed) continue;
      const DynamicMessage& own = set_.back();
      const std::int64_t turn = send_cycle(set_, now, cycle, own.slot);
      const bool turn_of_own = cycle % own.repetition == own.base_cycle;
      if (lost < 0 && turn_of_own) try_cycle(cycle + 1, end, now, history, 0);
      if (lost < 0) {
        try_cycle(cycle + 1, end, now, history, -1);
      } else if (!turn_of_own) {
        try_cycle(cycle + 1, end, now, history, lost);
      } else if (turn > own.latest_tx) {
        most_ = std::max(most_, lost + 1);
        try_cycle(cycle + 1, end, now, history, lost + 1);
      }
    }
  }

  const std::vector<DynamicMessage>& set_;
  std::int64_t cycles_;
  std::int64_t most_ = 0;
};

// Draws rivals in slots 1.. and a message behind them.
std::vector<DynamicMessage> drawn_set(RandomStream& stream, int rivals, std::int64_t longest_period, int repetitions) {
  std::vector<DynamicMessage> set;
  for (int slot = 1; slot <= rivals + 1; ++slot) {
    const std::int64_t minislots = stream.integer(5, 18);
    DynamicMessage one = once_in(slot, minislots, stream.integer(2, longest_period), 0);
    one.latest_tx = stream.integer(std::min<std::int64_t>(8, 41 - minislots), 41 - minislots);
    one.repetition = 1 << stream.integer(0, repetitions - 1);
    one.base_cycle = static_cast<int>(stream.integer(0, one.repetition - 1));
    if (slot > rivals) one.period = 1'000 * kCycle;
    set.push_back(one);
  }
  return set;
}

TEST(DynamicSegments, TheSearchAgreesWithAllArrivals) {
  RandomStream stream({.seed = 41});
  int found = 0, lost = 0, beyond = 0;
  for (int set = 0; set < 60; ++set) {
    std::vector<DynamicMessage> messages = drawn_set(stream, 2, 5, 2);
    if (set % 2 == 1) {
      for (std::size_t i = 0; i < 2; ++i) {
        messages[i].period += stream.integer(0, 999);
        messages[i].jitter = stream.integer(0, 999);
      }
    }
    const auto searched = searched_response(small_segment(), messages, 2);
    if (!searched) continue;
    ++found;
    constexpr std::int64_t kCycles = 7;
    const std::int64_t most = AllArrivals(messages, kCycles).most_lost();
    if (!searched->response.bounded() || searched->lost_cycles > 2) {
      ++beyond;
      EXPECT_LE(most, searched->response.bounded() ? searched->lost_cycles : kCycles) << "set " << set;
      continue;
    }
    EXPECT_EQ(most, searched->lost_cycles) << "set " << set;
    lost += most > 0 ? 1 : 0;
  }
  EXPECT_GT(found, 45);
  EXPECT_GT(lost, 10);
  EXPECT_LT(beyond, 30);
}

// Queues in a segment that runs, in time. Messages arrive at any instant.
class RunningSegment {
 public:
  RunningSegment(const DynamicSegment& segment, const std::vector<DynamicMessage>& set, RandomStream& stream)
      : segment_(segment), set_(set), queues_(set.size()), longest_(set.size(), 0) {
    for (std::size_t i = 0; i < set.size(); ++i) {
      std::int64_t at = stream.integer(0, set[i].period);
      while (at < 300 * kCycle) {
        queues_[i].push_back({at, at + stream.integer(0, set[i].jitter)});
        at += set[i].period + (stream.uniform() < 0.7 ? 0 : stream.integer(0, 2 * kCycle));
      }
      std::reverse(queues_[i].begin(), queues_[i].end());
    }
  }

  // Returns the longest response of each message, arrival to the end of its minislots.
  std::vector<std::int64_t> run() {
    const std::int64_t segment_start = kCycle - segment_.minislots * segment_.minislot;
    for (std::int64_t cycle = 0; cycle < 400; ++cycle) {
      const std::int64_t start = cycle * kCycle + segment_start;
      std::int64_t minislot = 1;
      int counted = 1;
      for (std::size_t i = 0; i < set_.size(); ++i) {
        const DynamicMessage& message = set_[i];
        minislot += std::max(0, message.slot - counted);
        counted = std::max(counted, message.slot);
        if (minislot > segment_.minislots) break;
        const std::int64_t now = start + (minislot - 1) * segment_.minislot;
        if (cycle % message.repetition != message.base_cycle || minislot > message.latest_tx || queues_[i].empty() ||
            queues_[i].back().queued > (segment_.decision == Decision::kAtTurn ? now : start))
          continue;
        minislot += message.minislots;
        ++counted;
        const std::int64_t end = start + (minislot - 1) * segment_.minislot;
        longest_[i] = std::max(longest_[i], end - queues_[i].back().arrival);
        queues_[i].pop_back();
      }
    }
    return longest_;
  }

 private:
  struct Waiting {
    std::int64_t arrival, queued;
  };
  const DynamicSegment& segment_;
  const std::vector<DynamicMessage>& set_;
  std::vector<std::vector<Waiting>> queues_;  // the oldest at the back
  std::vector<std::int64_t> longest_;
};

TEST(DynamicSegments, NoRunningSegmentExceedsTheResponse) {
  RandomStream stream({.seed = 42});
  int exact = 0, bounds = 0, unbounded = 0;
  for (int set = 0; set < 120; ++set) {
    std::vector<DynamicMessage> messages = drawn_set(stream, 4, 9, 2);
    if (messages[1].repetition == 2) {  // another one of the same slot, in the other cycles
      DynamicMessage other = messages[1];
      other.base_cycle = 1 - other.base_cycle;
      other.minislots = stream.integer(1, other.minislots);
      messages.insert(messages.begin() + 1, other);
    }
    for (DynamicMessage& one : messages) {
      one.jitter = stream.integer(0, 1) * stream.integer(0, 1'500);
      one.period += stream.integer(0, 999);
    }
    messages.back().period = stream.integer(4, 20) * kCycle;
    const DynamicSegment segment = small_segment(set % 2 == 0 ? Decision::kAtSegmentStart : Decision::kAtTurn);
    const std::vector<DynamicResponse> responses = dynamic_responses(segment, messages);
    const std::vector<DynamicResponse> covering = covering_bounds(segment, messages);
    const std::vector<std::int64_t> longest = RunningSegment(segment, messages, stream).run();
    for (std::size_t i = 0; i < messages.size(); ++i) {
      const Response& response = responses[i].response;
      unbounded += response.bounded() ? 0 : 1;
      if (!response.bounded()) continue;
      ++(response.quality == Quality::kExact ? exact : bounds);
      ASSERT_LE(longest[i], response.longest) << "set " << set << ", message " << i;
      if (covering[i].response.bounded()) {
        ASSERT_LE(response.longest, covering[i].response.longest);
      }
    }
  }
  EXPECT_GT(exact, 100);
  EXPECT_GT(bounds, 100);
  EXPECT_LT(unbounded, 300);
}

}  // namespace
}  // namespace ttf::schedules::timing::response
