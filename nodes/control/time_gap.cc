#include "nodes/control/time_gap.h"

#include <algorithm>

namespace ttf::nodes::control {

double wanted_clearance(const TimeGapConfig& config, double speed) {
  return config.standstill_m + config.time_gap_s * speed;
}

double time_gap_acceleration(const TimeGapConfig& config, double speed, double set_speed,
                             const std::optional<Ahead>& ahead) {
  const double cruise = config.set_gain * (set_speed - speed);
  if (!ahead) return cruise;
  const double follow = config.gap_gain * (ahead->clearance - wanted_clearance(config, speed)) +
                        config.speed_gain * (ahead->speed - speed);
  return std::min(cruise, follow);
}

}  // namespace ttf::nodes::control
