// A local improvement of first fit's order, for a packing that is above its bound.
//
// A step moves some of the signals that lie in the last bin to places further ahead in the order, and packs again. The
// step is kept unless the packing got worse: more bins, or as many with more bits in the last one. Where there
// are variants, each one above its bound has its last bin, and the bins of all are summed up. ("Squeaky wheel"
// optimisation: Joslin, Clements, Journal of Artificial Intelligence Research 10, 1999.) Steps are counted, and no
// clock decides.
#pragma once

#include <cstdint>
#include <vector>

#include "schedules/packing/first_fit.h"
#include "schedules/packing/instance.h"

namespace ttf::schedules::packing {

struct Effort {
  int steps = 200;         // for each part that is above its bound
  std::uint64_t seed = 1;  // for its draws
};

// By variant, the bins that it uses.
std::vector<int> bins_by_variant(const Instance& instance, const std::vector<Bin>& bins);

// Packs the order behind `fixed`, and improves it until each variant has at most its bound of bins (one bound without
// variants), or the steps are used up. `part` separates the streams of several parts.
Packed improved(const Instance& instance, Order order, Fit fit, const Packed& fixed, const std::vector<int>& bounds,
                const Effort& effort, int part);

}  // namespace ttf::schedules::packing
