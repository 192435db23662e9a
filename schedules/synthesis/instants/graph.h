// The precedences of a problem as a graph without rings.
#pragma once

#include <cstddef>
#include <vector>

#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis::instants {

struct Edge {
  std::size_t other = 0;  // activity
  Ticks gap = 0;          // from beginning to beginning
};

// A precedence that would close a ring is left out: its data is for the next round. Those along chains are taken first.
class Graph {
 public:
  explicit Graph(const Problem& problem);

  // Whether a way leads from one activity to another, or both are the same.
  bool leads(std::size_t from, std::size_t to) const;

  std::vector<std::vector<Edge>> before, after;  // by activity
};

}  // namespace ttf::schedules::synthesis::instants
