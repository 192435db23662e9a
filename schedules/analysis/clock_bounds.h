// The largest differences between the clocks of a cluster, and their effect on a time.
#pragma once

#include <cstdint>

#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

struct ClockBounds {
  std::int64_t apart_ns = 0;   // between any two nodes' global times: the assumed precision and a macrotick
  std::int64_t drift_ppb = 0;  // any oscillator's against true time

  // The largest difference when one oscillator measures a time and another judges it; rounded up.
  std::int64_t drift_ns(std::int64_t ns) const;
};
ClockBounds clock_bounds(const model::Cluster& cluster);

// Returns the largest drift of a node's oscillator: the given one, or the most it may have.
std::int64_t worst_drift_ppb(const model::Node& node);

}  // namespace ttf::schedules::analysis
