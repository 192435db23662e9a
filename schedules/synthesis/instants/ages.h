// Ages of a problem's chains, and their bound from below. An age ends where the last activity of its chain begins.
#pragma once

#include <vector>

#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis::instants {

struct Placed {
  Solution solution;
  std::vector<Ticks> ages;   // by chain: the longest way of a measurement to the last beginning
  std::vector<Ticks> least;  // the shortest way
  Ticks worst_age(const std::vector<Ticks>& beyond) const;
  Ticks sum_of_ages() const;
};

// Returns for every chain the age that no offsets can fall below: its longest way without any wait for resources.
std::vector<Ticks> least_ages(const Problem& problem);

// Returns for a chain the longest and the shortest way of its measurements to the beginning of the last activity.
struct Ways {
  Ticks longest = 0, shortest = 0;
};
Ways ways(const Problem& problem, const Chain& chain, const std::vector<Ticks>& offsets);

}  // namespace ttf::schedules::synthesis::instants
