// A number of bins that no packing can do without.
//
// Let S be a set of cycles, and consider the signals that can be sent in cycles of S alone. Each frame of S has W bits. So
//   bins >= ceil(frames / |S|),   frames = ceil(sum over these signals of (times sent in S) * weight(bits) / W).
// With S all cycles and weight(b) = b this is the load, ceil(sum bits / R / W). Windows make other sets S matter: all sets of
// cycles c with first <= c mod R <= last are tried.
//
// weight() is a dual feasible function (Fekete, Schepers, "New classes of fast lower bounds for bin packing problems",
// Mathematical Programming 91, 2001, u^(eps)): with a threshold k of 1..W/2, signals longer than W - k count as a whole frame, and
// signals shorter than k do not count. For a frame with such a long signal has less than k bits left. All k are tried. So the bound
// is exact for whole frames.
//
// Where slots are shared, each node needs frames of its own: the frames of all nodes are summed up, each rounded up.
#pragma once

#include "schedules/synthesis/packing/instance.h"

namespace ttf::schedules::synthesis::packing {

// Returns the bound of the bins that these signals share: those of one node, or of all nodes where slots are shared. Each must
// have a window and fit a frame.
int least_bins(const Instance& instance, const Order& signals);

// Returns the sum of bits / R / W of the signals, in bins.
double load(const Instance& instance, const Order& signals);

}  // namespace ttf::schedules::synthesis::packing
