// Longest responses of messages in FlexRay's dynamic segment, on one channel.
//
// Dynamic slots come in the order of their numbers 1, 2, ... (the frame identifier less gNumberOfStaticSlots). A
// silent slot takes one minislot, a slot with a frame takes `minislots`. So the turn of slot f is in minislot
//   f + sum (minislots_j - 1)        over the frames of lower slots in this cycle
// The message is sent if its turn is no later than pLatestTx. Otherwise it waits for its next cycle. A message may
// send in cycles base + k * repetition only (slot multiplexing), and messages of one slot must not share a cycle.
//
// Lower slots take the turn away for a whole cycle if they hold pLatestTx - f + 1 minislots more than silent ones.
// The largest number of lost cycles is a bin covering problem: cycles are bins, frames of lower slots are items (T.
// Pop, P. Pop, P. Eles, Z. Peng, A. Andrei, Real-Time Systems 39, 2008; M. Neukirchner, M. Negrean, R. Ernst, T.
// Bone, RTAS 2012, with slot multiplexing). It is strongly NP-hard.
//
//   exact   a search over all arrivals of lower slots: in each cycle every message arrives or not, as its period and
//           jitter allow, and the longest way to the message's turn counts. It needs decisions at the segment's start
//           and ends at kMostSearchedStates states.
//   bound   b cycles are lost only if sum_j (minislots_j - 1) min(n_j, b) >= b (pLatestTx - f + 1). n_j is the most
//           frames of message j in the window: those that arrive there, and those that its own longest delay carries
//           into it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "schedules/timing/response/response.h"

namespace ttf::schedules::timing::response {

inline constexpr std::size_t kMostSearchedStates = 10'000;
inline constexpr std::int64_t kMostOwnCycles = 4'096;  // a bound beyond them counts as unbounded

struct DynamicSegment {
  // When a controller looks whether a message waits. Only the first case has exact answers.
  enum class Decision : std::uint8_t { kAtSegmentStart, kAtTurn };

  std::int64_t cycle = 0;      // length of a communication cycle
  std::int64_t minislot = 0;   // length of a minislot
  std::int64_t minislots = 0;  // gNumberOfMinislots, 1..7988
  Decision decision = Decision::kAtTurn;
};

struct DynamicMessage {
  int slot = 0;                // f, 1..2047, ascending over a list
  int base_cycle = 0;          // 0..repetition - 1
  int repetition = 1;          // 1, 2, 4, ..., 64
  std::int64_t minislots = 0;  // length of its frame, with the dynamic slot idle phase
  std::int64_t latest_tx = 0;  // pLatestTx of its sender, at most latest_tx() of its longest frame
  std::int64_t period = 0;     // T, at least 1: the least time between two arrivals
  std::int64_t jitter = 0;     // J, from an arrival to the queue. The queue is first in, first out
};

struct DynamicResponse {
  Response response;             // from the arrival to the end of the frame's minislots
  std::int64_t lost_cycles = 0;  // its own cycles in which it waits and is not sent
  std::int64_t latest_turn = 0;  // the minislot of its turn behind these, counted from 1
};

// Returns the largest pLatestTx of a node whose longest frame takes `frame_minislots`; below 1 if it never fits.
std::int64_t latest_tx(const DynamicSegment& segment, std::int64_t frame_minislots);

// Takes messages by slot, those of one slot in any order. Exact where the search ends, a bound otherwise. Unbounded
// if lower slots can keep a message from its turn for ever, or if it arrives more often than its cycles come.
std::vector<DynamicResponse> dynamic_responses(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot);

// The bounds of all messages, and the search for the message at place `which`. The search returns nullopt for
// decisions at the turn, beyond kMostSearchedStates, and where a second instance of the message may wait behind the
// first.
std::vector<DynamicResponse> covering_bounds(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot);
std::optional<DynamicResponse> searched_response(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot,
                                                 std::size_t which);

}  // namespace ttf::schedules::timing::response
