// Says whether a solution keeps a problem, and how old data grows: by plain counting over hyperperiods, on its own. The solver's
// ways of saying the same are held against it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis {

// Returns what makes no sense in the problem itself, a sentence each: indices out of range, periods that are not positive,
// durations above the period, precedences between periods, hyperperiods above kLongestHyperperiod.
std::vector<std::string> mistakes(const Problem& problem);

inline constexpr Ticks kLongestHyperperiod = Ticks{1} << 40;
// A chain has at most so many outputs in a hyperperiod.
inline constexpr Ticks kMostOutputs = 100'000;

// Returns one sentence for every broken window, grid, fixed offset, precedence, pair on a resource, largest age and order. Needs a
// problem without mistakes.
std::vector<std::string> violations(const Problem& problem, const Solution& solution);

// Returns the pairs of activities that overlap on a resource.
std::vector<std::pair<std::size_t, std::size_t>> overlaps(const Problem& problem, const Solution& solution);

// Returns by how many ticks the first chain's source begins too late for the order; 0 or less: it is kept.
Ticks out_of_order(const Problem& problem, const Order& order, const Solution& solution);

// Returns the age of every chain [ticks].
std::vector<Ticks> ages(const Problem& problem, const Solution& solution);
Ticks age(const Problem& problem, const Chain& chain, const Solution& solution);

}  // namespace ttf::schedules::synthesis
