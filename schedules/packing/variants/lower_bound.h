// A number of slots that no schedule of several variants can do without.
//
// Take a family of signals that conflict in pairs (families.h). No two of them have a bit in common: they share a
// variant, whose vehicle has both. No two of different nodes have a slot in common (a frame, where slots are shared):
// in a shared variant it would have two owners. So the family is packed like the signals of one vehicle, and needs
//   sum over nodes of least_bins(its signals of the family)
// slots, or least_bins(the family) where slots are shared (least_bins: packing/lower_bound.h). The bound is the largest
// over families. The families of variants alone make it the largest bound of a single variant. As the owner of a slot
// may differ between variants, the sum over nodes of each node's largest bound is none: two nodes of different variants
// share a slot.
#pragma once

#include <vector>

#include "schedules/packing/instance.h"

namespace ttf::schedules::packing::variants {

// Returns the bound for these signals beside places that stand (empty, or with an entry for each signal of the
// instance). Bins that stand count, even if a packing anew needed fewer.
int least_slots(const Instance& instance, const Order& signals, const Places& standing);

// Returns the bound of each variant's vehicle alone.
std::vector<int> least_slots_by_variant(const Instance& instance, const Order& signals);

}  // namespace ttf::schedules::packing::variants
