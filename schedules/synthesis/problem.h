// A problem of time-triggered scheduling, bare of any bus: activities that repeat, resources that serve one at a time, and
// chains along which data grows old.
//
// An activity begins at offset + n period for every whole n, and its data is there `duration` later. Instants are whole
// ticks (macroticks of a FlexRay). Problems are pure data: instants/placement.h finds solutions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace ttf::schedules::synthesis {

using Ticks = std::int64_t;

// An offset's remainder by `period` is first, first + step, ..., at most last. The default allows every tick. A static slot:
// period is the cycle, first the segment's beginning, step the slot's length, last the last slot's beginning.
struct Grid {
  Ticks period = 1, first = 0, last = 0, step = 1;
};

struct Activity {
  std::string name;                     // in the plan's words
  std::optional<std::size_t> resource;  // none: it shares nothing
  Ticks period = 0;                     // > 0
  Ticks duration = 0;                   // 0..period; the worst case. 0 takes nothing of its resource
  Grid grid;
  std::optional<Ticks> fixed;  // it stands there and never moves; the grid does not bind it
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
constexpr Ticks common_period(const Activity& a, const Activity& b) {
  return own_their_places(a, b) ? a.turn : std::gcd(a.period, b.period);
}

// At most one activity at a time in each lane: a processor, a static segment, a CAN.
struct Resource {
  std::string name;
};

// `after` begins at least `gap` behind the end of `before`: at the next beginning at which the data is there.
struct Precedence {
  std::size_t before = 0, after = 0;
  Ticks gap = 0;
};

// Data passes along the activities, whose periods may differ. Each reads at its beginning the newest that its predecessor has
// finished, `gaps` ticks earlier or more (a gap for every pair of neighbours). A negative gap, of at most the duration, has data
// that is there before the end. An age ends where the last activity begins (instants/ages.h).
struct Chain {
  std::string name;
  std::vector<std::size_t> activities;  // at least one
  std::vector<Ticks> gaps;
  std::optional<Ticks> largest_age;
};

struct Problem {
  std::vector<Activity> activities;
  std::vector<Resource> resources;
  std::vector<Precedence> precedences;
  std::vector<Chain> chains;
};

struct Solution {
  std::vector<Ticks> offsets;  // by activity
};

}  // namespace ttf::schedules::synthesis
