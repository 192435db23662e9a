// Problems as they are met in vehicles, drawn: nodes on a FlexRay, tasks and messages with joint phases, chains through both.
//
// Periods are the cycle times 1, 2, 4, ..., 64. Each node's tasks load its processor to `load`, and messages load the static
// segment to `load` or, because slots are whole, less than a slot below. A message has its sender's period, fills a static slot and
// follows its sender within a period. A chain is task, message, task, message, task on three nodes; of the chains 70 % have one
// period and 20 % two, as Kramer, Ziegenbein and Hamann count them (WATERS 2015, table VI).
#pragma once

#include <cstdint>

#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis {

struct Shape {
  int nodes = 6;      // >= 3
  int tasks = 24;     // >= nodes
  int messages = 32;  // in_chains of them in chains, two in each
  double load = 0.7;  // 0.2..0.9
  double in_chains = 0.5;
  Ticks cycle = 5000;  // us; the static segment takes four fifths of it
  std::uint64_t seed = 1;
};

// Activities are first the tasks, then the messages. Resources are the processors, then the static segment.
Problem generated(const Shape& shape);

// The share of its time that a resource is busy; of a static segment: the share of its slots.
double load_of(const Problem& problem, std::size_t resource);

}  // namespace ttf::schedules::synthesis
