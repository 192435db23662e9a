// The communication cycles of a timing diagram: number -> start, in true time.
//
// Nodes agree on the cycle counter, not on the number of its wraps. A node that came back into a running
// cluster counts whole rounds fewer than the others. The numbers follow the oldest count among the window's
// frames. Every frame shows when a cycle began, whatever its sender's count.
#pragma once

#include <cstdint>
#include <map>

#include "report/timing/data.h"

namespace ttf::report::timing {

// Returns all cycles that touch the window and one on either side; cycles before cycle 0 have negative
// numbers. Returns an empty map without a cycle length or if the lines are too many for a grid. A count with
// frames of a single cycle, while others have more, is a mistake of the log. `cycles`: values of the cycle counter.
std::map<std::int64_t, TrueTime> cycle_starts(const TimingData& data, Duration cycle, int cycles, TrueTime from,
                                              TrueTime to);

}  // namespace ttf::report::timing
