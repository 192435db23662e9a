// A problem of time-triggered scheduling, bare of any bus: activities that repeat, resources that serve one at a time, and
// chains along which data grows old.
//
// An activity begins at offset + n period for every whole n, and its data is there `duration` later. Instants are whole
// ticks (macroticks of a FlexRay). Problems are pure data: checker.h says whether a solution keeps one, solver/solve.h finds
// solutions, solver/explain.h says why there is none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace ttf::schedules::synthesis {

using Ticks = std::int64_t;

// Allowed offsets are first..last, both included.
struct Window {
  Ticks first = 0, last = 0;
};

// An offset's remainder by `period` is first, first + step, ..., at most last. The default allows every tick. A static slot:
// period is the cycle, first the segment's beginning, step the slot's length, last the last slot's beginning.
struct Grid {
  Ticks period = 1, first = 0, last = 0, step = 1;
};

struct Activity {
  std::string name;                     // in the plan's words
  int line = 0;                         // in the plan; 0: none
  std::optional<std::size_t> resource;  // none: it shares nothing
  Ticks period = 0;                     // > 0
  Ticks duration = 0;                   // 0..period; the worst case. 0 takes nothing of its resource
  Window window;
  Grid grid;
  std::optional<Ticks> fixed;  // it stands there and never moves; window and grid do not bind it
  // The lanes of the resource that it takes, as bits. Activities without a common lane do not disturb each other: lists on the two
  // channels of a static segment.
  std::uint8_t lanes = 3;
  // A resource may come round in turns of this length, and each place in a turn then has one owner: FlexRay 2.1's static slots, with a
  // turn for each cycle. It divides the period. 0: places have no owner.
  Ticks turn = 0;
  std::size_t owner = 0;
};

inline constexpr std::uint8_t kLanes[] = {1, 2};

// Whether the two disturb each other.
constexpr bool share_a_lane(const Activity& a, const Activity& b) {
  return a.resource && a.resource == b.resource && (a.lanes & b.lanes) != 0;
}

// Whether their places in a turn must differ.
constexpr bool own_their_places(const Activity& a, const Activity& b) {
  return a.turn > 0 && a.turn == b.turn && a.owner != b.owner;
}

// Returns the time after which the two meet alike.
constexpr Ticks meeting_time(const Activity& a, const Activity& b) {
  return own_their_places(a, b) ? a.turn : std::gcd(a.period, b.period);
}

// At most one activity at a time in each lane: a processor, a static segment, a CAN.
struct Resource {
  std::string name;
};

// `after` begins at least `gap` and at most `most` behind the end of `before`. Both have one period. Without `most` it is
// gap + period - 1: the next beginning at which the data is there.
struct Precedence {
  std::size_t before = 0, after = 0;
  Ticks gap = 0;
  std::optional<Ticks> most;
  int line = 0;
};

// Data passes along the activities, whose periods may differ. Each reads at its beginning the newest that its predecessor has
// finished, `gaps` ticks earlier or more (a gap for every pair of neighbours, or none at all: 0). A negative gap, of at most the
// duration, has data that is there before the end. The age of an output is its end
// less the beginning of the first activity that it rests on. If it is not `reduced`, it counts until the end of the next output, while
// the output is in force. The chain's age is the largest over the hyperperiod (MRDA if reduced, else MDA: Guenzel et al., ECRTS
// 2023).
struct Chain {
  std::string name;
  std::vector<std::size_t> activities;  // at least one
  std::vector<Ticks> gaps;
  std::optional<Ticks> largest_age;
  bool reduced = true;
  int line = 0;
};

// Data is taken in the order of its beginnings: two chains meet at one place, where `first` is read by its activity `first_at` and
// `second` by its activity `second_at`. After each beginning of the one, the next beginning of the other rests on a beginning
// of its chain at least `apart` later. All activities up to there have one period.
struct Order {
  std::size_t first = 0, first_at = 0;  // chain, and where along it
  std::size_t second = 0, second_at = 0;
  Ticks apart = 0;
};

struct Problem {
  std::vector<Activity> activities;
  std::vector<Resource> resources;
  std::vector<Precedence> precedences;
  std::vector<Chain> chains;
  std::vector<Order> orders;
};

struct Solution {
  std::vector<Ticks> offsets;  // by activity
};

}  // namespace ttf::schedules::synthesis
