// How far apart the clocks of a cluster may be, and what that makes of a time.
#pragma once

#include <cstdint>

#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

struct ClockBounds {
  std::int64_t apart_ns = 0;   // any two nodes' global times: the assumed precision and a macrotick
  std::int64_t drift_ppb = 0;  // any oscillator against true time

  // What two oscillators can make of a time, the one it runs on and the one it is judged by; rounded up.
  std::int64_t drift_ns(std::int64_t ns) const;
};
ClockBounds clock_bounds(const model::Cluster& cluster);

// What one node's oscillator may be off by: its drift if that is given, else the most it may have.
std::int64_t worst_drift_ppb(const model::Node& node);

}  // namespace ttf::schedules::analysis
