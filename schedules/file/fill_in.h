// Completes the schedule of a cluster file that leaves values out: repetitions, instants and slots (schedules/left_out/earliest.h),
// the shortest periods of CAN messages (shortest_periods.h), and deadlines.
#pragma once

#include "core/errors.h"
#include "schedules/left_out/parts.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::file {

// Cluster::derived lists the values. A value that does not follow is a finding. The cluster is otherwise whole.
void fill_in(model::Cluster& cluster, left_out::Parts& parts, Findings& findings);

}  // namespace ttf::schedules::file
