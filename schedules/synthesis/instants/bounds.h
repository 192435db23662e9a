// Bounds of the largest age from below, without instants.
#pragma once

#include <vector>

#include "schedules/synthesis/instants/graph.h"
#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis::instants {

// A piece of work on a machine, looked at backwards from the use of the data: it may end `tail` before the use at the latest,
// takes `duration`, and its data is `head` old when it begins.
struct Piece {
  Ticks tail = 0, duration = 0, head = 0;
};

// Returns the least largest age of pieces that one machine works at one at a time: Jackson's preemptive schedule, which no
// schedule without preemption is better than (Carlier, EJOR 11, 1982, proposition 1).
Ticks jackson(std::vector<Piece> pieces);

// Returns an age that the largest of all chains cannot fall below: their longest ways, and their waits for each other on one
// processor or the static segment. By chain, `beyond` counts in addition (none: 0). Activities of one resource that begin in
// rounds of one period are apart in every count of rounds, so that the bound holds for periodic beginnings, too.
Ticks least_worst_age(const Problem& problem, const std::vector<Ticks>& beyond);

}  // namespace ttf::schedules::synthesis::instants
