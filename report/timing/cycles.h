// The communication cycles of a timing diagram: number -> start, in true time.
//
// Nodes agree on the cycle counter, not on how often it has wrapped: one that came back into a running cluster counts
// whole rounds less than the others. The numbers are those of the oldest count that the window's frames tell of, and
// every frame says when a cycle began, whichever count its sender has.
#pragma once

#include <cstdint>
#include <map>

#include "report/timing/data.h"

namespace ttf::report::timing {

// All cycles that touch the window and one on either side; those before cycle 0 have negative numbers. Empty without a
// cycle length or where there are too many lines to be a grid. A count that a single cycle's frames tell of, where
// others have more, is a mistake of the log.
std::map<std::int64_t, TrueTime> cycle_starts(const TimingData& data, Duration cycle, TrueTime from, TrueTime to);

}  // namespace ttf::report::timing
