// The spread of several nodes' global times at one instant.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::sim::engine {

// A node that joined a running cluster has its cycle only modulo gCycleCountMax + 1, and counts on from
// there. So two clocks that agree may differ by whole rounds of the cycle counter; only the rest counts.
class ClockSpread {
 public:
  explicit ClockSpread(const schedules::model::Cluster& cluster)
      : round_(cluster.flexray.cycle_ps() * (cluster.flexray.gCycleCountMax + 1) / 1000), half_(round_ / 2) {}

  void add(GlobalTime time) {
    if (!any_) first_ = time;
    any_ = true;
    std::int64_t difference = (time - first_).ns;
    if (difference > half_ || difference < -half_) {
      difference %= round_;
      if (difference > half_) difference -= round_;
      if (difference < -half_) difference += round_;
    }
    low_ = std::min(low_, difference);
    high_ = std::max(high_, difference);
  }
  Duration width() const { return {high_ - low_}; }

 private:
  std::int64_t round_, half_;
  bool any_ = false;
  GlobalTime first_{};
  std::int64_t low_ = 0, high_ = 0;
};

}  // namespace ttf::sim::engine
