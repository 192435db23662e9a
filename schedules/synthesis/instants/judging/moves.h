// Better phases of measurements, by a local search with counted steps.
#pragma once

#include <functional>

#include "schedules/synthesis/instants/ages.h"
#include "schedules/synthesis/instants/reading.h"

namespace ttf::schedules::synthesis::instants::judging {

// Moves measurements that do not stand, one at a time, while `value` of the offsets becomes less. Steps go from a
// quarter of the period by halves down to a tick. Ages stay within the limits, and lists in their order. Returns the
// best placement. `moves` counts the values that were asked for.
Placed moved_measurements(const Reading& reading, const Limits& limits, Placed start,
                          const std::function<double(const std::vector<Ticks>& offsets)>& value, int most_moves,
                          int& moves);

// Returns the ages of offsets; none where one is above its limit, or lists would not be fused in the order of
// measurements.
std::optional<Placed> placed_within(const Reading& reading, const Limits& limits, std::vector<Ticks> offsets);

}  // namespace ttf::schedules::synthesis::instants::judging
