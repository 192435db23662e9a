// A cluster as a FIBEX 3.1 file (ASAM MCD-2 NET): its FlexRay side, for the tools that read FIBEX.
//
// Parameters stand where schedules/exchange/fibex/parameters.h says, lists as schedules/exchange/fibex/lists.h says.
// Each slot is a frame and a triggering per channel; a node is an ECU with one controller and a connector per channel,
// whose ports say what it sends and what its tasks read. Not in the file, for FIBEX has no place for it:
// tasks, sensors and drifts; and the CANs.
#pragma once

#include <string>

#include "schedules/model/cluster.h"

namespace ttf::schedules::exchange::fibex {

// The same bytes for the same cluster. The cluster should be proved consistent (schedules/check/checker.h).
std::string fibex_text(const model::Cluster& cluster);

}  // namespace ttf::schedules::exchange::fibex
