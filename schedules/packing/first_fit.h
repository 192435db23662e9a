// First fit: each signal, in order, takes the first place in the first bin that has one (Fit, in bin.h).
//
// The theorem of whole frames: with signals that fill their frames, free windows and repetitions 1, 2, 4, ..., first
// fit by ascending repetition needs ceil(sum 1/R) bins, the fewest. For: before a signal of repetition R is placed,
// each bin is divided into R classes of cycles, and each class is full or free, because all repetitions so far divide
// R. So the signal finds a place in an opened bin unless all of them are full. Therefore all bins except the last are
// full. (Divisible sizes: Coffman, Garey, Johnson, "Bin packing with divisible item sizes", Journal of Complexity 3,
// 1987.) The same holds for signals of one length that divides the payload. It holds for all nodes together where slots
// are shared.
#pragma once

#include <vector>

#include "schedules/packing/bin.h"
#include "schedules/packing/instance.h"

namespace ttf::schedules::packing {

struct Packed {
  std::vector<Bin> bins;
  Places places;  // for all signals of the instance
};

// Places the signals of `order` into the bins of `packed` and into new ones behind them. Each signal must have a window
// and fit a frame.
void first_fit(const Instance& instance, const Order& order, Fit fit, Packed& packed);

// Begins with places that stand. They must not overlap (check.h).
Packed with_fixed(const Instance& instance, const Places& fixed);

}  // namespace ttf::schedules::packing
