// Ages of a problem's chains, their limits, and their bound from below. An age ends where the last activity of its chain begins.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis::instants {

// Limits beside the problem's own: for objectives that are already met.
struct Limits {
  std::vector<Ticks> largest_ages;  // by chain (none: no limit)
  std::vector<Ticks> beyond;        // by chain: so much longer counts an age (none: nothing)
  std::optional<Ticks> worst_age;   // every chain's, so counted
  std::optional<Ticks> sum_of_ages;
  std::optional<Ticks> jitter;     // the largest difference between a chain's longest and shortest way
  std::optional<Ticks> last_slot;  // end of the last slot in use within the cycle [ticks]
};

// Returns the largest age that a chain may have: the problem's or the limits', whichever is less. The largest number: any.
Ticks limit_of(const Problem& problem, const Limits& limits, std::size_t chain);

struct Placed {
  Solution solution;
  std::vector<Ticks> ages;   // by chain: the longest way of a measurement to the last beginning
  std::vector<Ticks> least;  // the shortest way
  Ticks worst_age(const std::vector<Ticks>& beyond) const;
  Ticks sum_of_ages() const;
  Ticks jitter() const;
};

// Returns for every chain the age that no offsets can fall below: its longest way without any wait for resources.
std::vector<Ticks> least_ages(const Problem& problem);

// Returns when the chain's last activity begins that rests on the beginning of the first one at `start`.
Ticks read_at(const Problem& problem, const Chain& chain, const std::vector<Ticks>& offsets, Ticks start);

// Returns for a chain the longest and the shortest way of its measurements to the beginning of the last activity.
struct Ways {
  Ticks longest = 0, shortest = 0;
};
Ways ways(const Problem& problem, const Chain& chain, const std::vector<Ticks>& offsets);

}  // namespace ttf::schedules::synthesis::instants
