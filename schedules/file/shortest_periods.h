// The shortest periods of CAN messages that a cluster file leaves out: those that the responses of their senders allow, which
// are the largest that the check accepts (check/responses.cc).
#pragma once

#include "schedules/model/cluster.h"

namespace ttf::schedules::file {

// Fills in the periods that are zero, rounded down to 10 us. A period stays zero if nothing bounds the time between two lists:
// no task writes them, several nodes do, or the sender may be busy without end. The cluster is otherwise whole.
void derive_shortest_periods(model::Cluster& cluster);

}  // namespace ttf::schedules::file
