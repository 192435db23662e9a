// `schedule check CLUSTER --can-errors 10ms`: responses of the lists on a cluster's CANs while errors strike frames.
#pragma once

#include <string>

#include "schedules/model/cluster.h"

namespace ttf::cli::schedule {

// `apart` is the least time between two errors on a CAN, as text. Prints each list's longest time on its CAN without and
// with errors. Returns 1 if a list may be queued before the last one of its message is sent. Throws InputError.
int check_can_errors(const schedules::model::Cluster& cluster, const std::string& apart, bool json);

}  // namespace ttf::cli::schedule
