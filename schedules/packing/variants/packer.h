// Packs the signals of several variants of a vehicle into one schedule.
//
// A signal has the same place in all its variants; the owner of a slot may differ between variants, as another unit may
// be plugged in (Dvorak, Hanzalek, IEEE Transactions on Vehicular Technology, 2018). So there are two stages: each node
// packs bins of its own, in which signals without a common variant may overlap, and then bins without a common variant
// may have one slot (columns.h). The first stage finds several packings of each node (candidates.h), and the second one
// chooses among them. Where slots are shared among nodes, there is one stage for all nodes.
#pragma once

#include "schedules/packing/packer.h"

namespace ttf::schedules::packing::variants {

// As pack() of packer.h, for an instance with variants. The solution has one part, with all nodes: its bins are slots,
// its load is the largest of a variant, and its bound that of lower_bound.h.
Solution pack_variants(const Instance& instance, const Places& fixed = {}, const Effort& effort = {});

}  // namespace ttf::schedules::packing::variants
