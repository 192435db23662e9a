// Writes the FlexRay side of a cluster as a FIBEX 3.1 file (ASAM MCD-2 NET), for tools that read FIBEX.
//
// schedules/exchange/fibex/parameters.h has the places of parameters, schedules/exchange/fibex/lists.h those of
// lists. Each slot is a frame and a triggering per channel. A node is an ECU with one controller and a connector
// per channel, with ports for the frames it sends and those its tasks read. FIBEX has no place for tasks,
// sensors and drifts; these and the CANs are not in the file.
#pragma once

#include <string>

#include "schedules/model/cluster.h"

namespace ttf::schedules::exchange::fibex {

// Returns the same bytes for the same cluster, which should have passed schedules/check/checker.h.
std::string fibex_text(const model::Cluster& cluster);

}  // namespace ttf::schedules::exchange::fibex
