// Bounds of ages from relaxations: how young a chain's data could be if nothing but what is fixed stood in its way.
#pragma once

#include <span>
#include <vector>

#include "schedules/synthesis/problem.h"
#include "schedules/synthesis/solver/solve.h"

namespace ttf::schedules::synthesis::solver {

// The part of a problem that `activities` see: they, fixed activities on their resources, the precedences among these, no chain.
struct Part {
  Problem problem;
  std::vector<std::size_t> numbers;  // by activity of the part: its number in the whole, ascending

  void add(Chain chain);  // a chain of the whole, all of whose activities the part has
};
Part part_of(const Problem& problem, std::span<const std::size_t> activities);

// Returns an age that the chain has at least, with any offsets: the least for the chain alone, if that is found within a small
// effort.
Ticks least_age_alone(const Problem& problem, const Chain& chain);

}  // namespace ttf::schedules::synthesis::solver
