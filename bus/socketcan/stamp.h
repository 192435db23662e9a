// The kernel's stamps on the host's clock. They are CLOCK_REALTIME, which somebody may set at any time; so both clocks
// are read together whenever a stamp is looked at, never once for all.
#pragma once

#include <cstdint>

#include "bus/ports/live_medium.h"

namespace ttf::bus::socketcan {

// Both clocks at one instant, to half of what reading them takes (some 20 ns each); a reading that was interrupted is
// made again, twice at most.
struct ClockPair {
  ports::HostTime host;
  std::int64_t realtime_ns = 0;
  ports::HostTime now;  // when the reading was over
};
ClockPair clock_pair();

// When what bears this stamp (ns of CLOCK_REALTIME; 0: none) was stamped. Not later than pair.now: a stranger's frame
// may bear whatever transmission time it was queued with, and the clock may have been set.
ports::HostTime on_host(std::int64_t stamp_ns, const ClockPair& pair);

}  // namespace ttf::bus::socketcan
