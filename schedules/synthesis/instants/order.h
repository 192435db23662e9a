// The order of measurements: a list must not be fused before an older one.
#pragma once

#include <optional>
#include <vector>

#include "schedules/synthesis/instants/graph.h"
#include "schedules/synthesis/instants/reading.h"

namespace ttf::schedules::synthesis::instants {

// Makes measurements earlier, until lists are fused in the order of their stamps. `at` has the beginnings by activity, in one
// count of ticks over all rounds. Returns false where an instant that stands forbids it.
bool measure_in_order(const Reading& reading, const std::vector<bool>& placed, std::vector<Ticks>& at);

// Returns whether offsets keep that order; none if a sensor has no chain that leads to its fusion. A measurement that was
// made earlier by a period is a newer one again: its list then carries the next instance.
std::optional<bool> fused_in_order(const Reading& reading, const std::vector<Ticks>& offsets);

// Returns whether placements as late as may be, one after the other, meet every order of two fusions of a node. Where two
// must end at different times, or something else is between them, one of the orders may need a fusion that begins earlier
// than it must. `main`: by activity, whether it is placed so.
bool all_orders_agree(const Reading& reading, const Graph& graph, const std::vector<bool>& main);

}  // namespace ttf::schedules::synthesis::instants
