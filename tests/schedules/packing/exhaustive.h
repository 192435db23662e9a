// The fewest bins of a small instance, by trying all places of all signals.
#pragma once

#include "schedules/packing/instance.h"

namespace ttf::schedules::packing {

// Returns the fewest bins for the signals, at most 8 cycles of at most 8 bits. In each variant a bin has one owner
// (each cycle of it, where slots are shared). A signal has one place in all its variants.
int fewest_bins(const Instance& instance);

}  // namespace ttf::schedules::packing
