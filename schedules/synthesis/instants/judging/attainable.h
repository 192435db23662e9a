// Ages that no instants have.
#pragma once

#include <cstddef>
#include <vector>

#include "core/time.h"
#include "schedules/synthesis/instants/reading.h"
#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis::instants::judging {

// Chains that end with one task.
struct EndChains {
  std::vector<std::size_t> chains;  // at least one
  std::vector<Ticks> largest_ages;  // by these chains
};

// Returns false if no instants have ages at first use between these, both included, by chain. Where a chain has several
// periods, nothing is ruled out: one measurement may be used late, and the next one soon.
//
// Chains wait for each other on processors and the static segment (least_worst_age). Lists that one processor fuses
// wait in the order of their measurements (Plan::in_order): looked at backwards from the use, a list's fusion begins
// where those of all newer lists have ended. Where ages lie apart, this order is known. The rest is Jackson's
// preemptive schedule of the fusions (bounds.h).
bool attainable(const Reading& reading, const EndChains& end, std::int64_t tick_ps,
                const std::vector<Duration>& youngest, const std::vector<Duration>& oldest);

// Returns the least worst age of these chains, with so much added to each.
Ticks least_worst_of(const Problem& problem, const std::vector<std::size_t>& chains, const std::vector<Ticks>& beyond);

}  // namespace ttf::schedules::synthesis::instants::judging
