// A number of bins that no packing can do without.
//
// Let S be a set of cycles, M = 1, 2, 4, ... a modulus, and consider the signals of a node that can be sent in cycles
// of S alone and have a repetition R of at most M. A class is the cycles c of a bin with one c mod M. Such a signal
// lies in M / R whole classes, and those in a class have at most W bits. So
//   classes >= ceil(sum over these signals of M / R * weight(bits) / W)
//   frames = classes * cycles / M,  bins >= ceil(frames / |S|).
// With S all cycles and weight(b) = b this is the load, ceil(sum bits / R / W). Windows make other sets S matter: the
// sets of cycles c with first <= c mod R <= last are tried, from the beginning of a window to the end of one.
//
// weight() is a dual feasible function (Fekete, Schepers, "New classes of fast lower bounds for bin packing problems",
// Mathematical Programming 91, 2001, u^(eps)): with a threshold k of 1..W/2, signals longer than W - k count as a whole
// frame, and signals shorter than k do not count. For a frame with such a long signal has less than k bits left. All k
// are tried. So the bound is exact for whole frames.
//
// Where slots are shared, each node needs frames of its own: the frames of all nodes are summed up.
#pragma once

#include "schedules/packing/instance.h"

namespace ttf::schedules::packing {

// Returns the bound of the bins that these signals share: those of one node, or of all nodes where slots are shared.
// Each must have a window and fit a frame.
int least_bins(const Instance& instance, const Order& signals);

// Returns the sum of bits / R / W of the signals, in bins.
double load(const Instance& instance, const Order& signals);

}  // namespace ttf::schedules::packing
