// A solution, written into the cluster: instants, slots, and the deadlines that follow from the tasks' waiting.
#pragma once

#include <vector>

#include "core/time.h"
#include "schedules/model/cluster.h"
#include "schedules/synthesis/instants/placement.h"
#include "schedules/synthesis/instants/reading.h"

namespace ttf::schedules::synthesis::instants {

// Returns the whole cluster. A deadline that the plan leaves out is the longest time from activation to end, in whole 10 us.
model::Cluster with_instants(const plan::Plan& plan, const Timed& timed, const Reading& reading,
                             const Solution& solution);

// Returns by activity the offsets of such a cluster.
std::vector<Ticks> offsets_of(const Read& read, const model::Cluster& cluster);

// Returns the age of the chain's measurements when its last task begins, as `schedule check` bounds it
// (schedules/analysis/ages.h). The cluster must have passed check().
struct AgeBounds {
  Duration best{}, worst{};
};
AgeBounds age_bounds(const model::Cluster& cluster, const plan::PlannedChain& chain);

}  // namespace ttf::schedules::synthesis::instants
