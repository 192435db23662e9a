// Several packings of signals that may share bins: those of one node, or of all where slots are shared.
//
// First fit tries the orders of orders.h, each also with the signals of many variants first, or first in their period.
// A packing is worth keeping unless another one has no more bins in any variant, and fewer in some.
#pragma once

#include <string>
#include <vector>

#include "schedules/packing/first_fit.h"
#include "schedules/packing/improvement.h"

namespace ttf::schedules::packing::variants {

struct Candidate {
  Packed packed;
  std::vector<int> bins;  // by variant
  std::string how;
};

// Packs the signals behind `fixed`. If no packing has at most `bounds` of bins in each variant, the best one is
// improved besides (improvement.h). Returns one candidate or more, those with the fewest bins over all variants first.
std::vector<Candidate> candidates(const Instance& instance, const Order& signals, const Packed& fixed,
                                  const std::vector<int>& bounds, const Effort& effort, int part);

}  // namespace ttf::schedules::packing::variants
