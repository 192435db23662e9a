// Converts the kernel's stamps to the machine's clock. They are CLOCK_REALTIME, which may be set at any time,
// so both clocks are read together for every stamp.
#pragma once

#include <cstdint>

#include "bus/ports/live_medium.h"

namespace ttf::bus::socketcan {

// Both clocks at one instant, accurate to half the reading time (some 20 ns each). An interrupted reading is
// repeated, at most twice.
struct ClockPair {
  ports::MachineTime host;
  std::int64_t realtime_ns = 0;
  ports::MachineTime now;  // when the reading ended
};
ClockPair clock_pair();

// Returns the instant of a stamp (ns of CLOCK_REALTIME; 0: none), but no later than pair.now. A foreign frame
// may bear any transmission time that it was queued with, and the clock may have been set.
ports::MachineTime on_host(std::int64_t stamp_ns, const ClockPair& pair);

}  // namespace ttf::bus::socketcan
