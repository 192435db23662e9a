#include "schedules/analysis/clock_bounds.h"

#include <algorithm>
#include <cstdlib>

#include "core/int128.h"
#include "schedules/model/wire_times.h"

namespace ttf::schedules::analysis {

std::int64_t ClockBounds::drift_ns(std::int64_t ns) const {
  return static_cast<std::int64_t>(static_cast<Int128>(ns) * 2 * drift_ppb / 1'000'000'000) + 1;
}

ClockBounds clock_bounds(const model::Cluster& cluster) {
  ClockBounds bounds;
  bounds.apart_ns = (assumed_precision_ps(cluster.flexray) + cluster.flexray.gdMacrotick_ps + 999) / 1000;
  for (const model::Node& node : cluster.nodes) bounds.drift_ppb = std::max(bounds.drift_ppb, worst_drift_ppb(node));
  return bounds;
}

std::int64_t worst_drift_ppb(const model::Node& node) {
  return node.drift_ppb ? std::abs(*node.drift_ppb) : node.max_drift_ppb;
}

}  // namespace ttf::schedules::analysis
