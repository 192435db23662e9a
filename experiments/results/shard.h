// A part of an experiment, for one of several machines; and the number of workers on this machine.
#pragma once

#include <cstdint>

namespace ttf::experiments::results {

// Indices i with i mod count == part.
struct Shard {
  std::uint32_t part = 0, count = 1;
  bool has(std::uint64_t index) const { return index % count == part; }
};

// As many as there are processors.
unsigned workers_here();

}  // namespace ttf::experiments::results
