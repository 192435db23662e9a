// Adaptive cruise control: keeps a set speed, and a time gap to the vehicle ahead (nodes/control/time_gap.h).
#pragma once

#include <optional>
#include <string_view>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "nodes/control/limits.h"
#include "nodes/control/time_gap.h"
#include "nodes/driving/ahead.h"
#include "nodes/driving/command.h"
#include "nodes/host/step.h"

namespace ttf::nodes::driving {

struct CruiseConfig {
  double set_speed_mps = 30.0;
  control::TimeGapConfig law;
  control::LimitsBySpeed limits;
  PathConfig path;
  // A command counts at the actuator for this long. The last one is remembered for as long without a view.
  Duration memory = Duration::milliseconds(100);
};
// Reads all but the vehicle's front and the memory.
CruiseConfig load_cruise(YamlMap& yaml);

// Ports `image` and `odometry` -> `command`. Each execution issues a command; it is invalid without a view of the way
// ahead. After a gap within the last command's life the acceleration goes on from there, with the jerk of one
// execution, or of `memory` at most. After a longer one a deceleration does so, too: giving up the brakes at once would
// be a jerk beyond all limits, and the vehicle brakes meanwhile. An acceleration begins anew with zero.
class AdaptiveCruiseControl final : public host::Step {
 public:
  AdaptiveCruiseControl(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                        const CruiseConfig& config);
  void run(host::StepContext& context) override;
  bool reads_newest(std::string_view port) const override { return port == "odometry"; }

 private:
  CruiseConfig config_;
  WayAhead way_;
  CommandOutput out_;
  double before_ = 0.0;              // [m/s^2], the last valid command from which the next one goes on
  std::optional<LocalTime> issued_;  // when it was issued
  LocalTime last_{};                 // the last execution
};

}  // namespace ttf::nodes::driving
