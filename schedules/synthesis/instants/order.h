// The order of measurements: a list must not be fused before an older one.
#pragma once

#include <vector>

#include "schedules/synthesis/instants/reading.h"

namespace ttf::schedules::synthesis::instants {

// Makes measurements earlier, until lists are fused in the order of their stamps. `at` has the beginnings by activity, in one
// count of ticks over all rounds. Returns false where an instant that stands forbids it.
bool measure_in_order(const Reading& reading, const std::vector<bool>& placed, std::vector<Ticks>& at);

}  // namespace ttf::schedules::synthesis::instants
