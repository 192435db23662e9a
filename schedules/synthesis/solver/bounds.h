// Bounds of ages from relaxations: how young a chain's data could be if nothing but what is fixed stood in its way. Two
// chains in company may be bound to be older.
#pragma once

#include <span>
#include <vector>

#include "schedules/synthesis/problem.h"
#include "schedules/synthesis/solver/solve.h"

namespace ttf::schedules::synthesis::solver {

// The part of a problem that `activities` see: they, fixed activities on their resources, the precedences among these,
// no chain.
struct Part {
  Problem problem;
  std::vector<std::size_t> numbers;  // by activity of the part: its number in the whole, ascending

  void add(Chain chain);  // a chain of the whole, all of whose activities the part has
};
Part part_of(const Problem& problem, std::span<const std::size_t> activities);

// Returns an age that the chain has at least, with any offsets: the least for the chain alone, if that is found within
// a small effort.
Ticks least_age_alone(const Problem& problem, const Chain& chain);

// Whether the largest ages of two chains are shown to contradict each other, whatever all others do. It takes about 100
// splits (turns.h) a pair from `splits`, as long as there are any.
bool two_chains_contradict(const Problem& problem, std::int64_t& splits);

// Returns the problem without what a whole period allows: windows and precedences. If offsets may then turn together by
// the grids' periods, an activity of the longest period begins within the first of them. A problem with a solution has
// one when it is folded.
Problem folded(Problem problem);

}  // namespace ttf::schedules::synthesis::solver
