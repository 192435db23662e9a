// Lane keeping: steers the vehicle along the middle of its lane (nodes/control/stanley.h), and warns when it leaves the
// lane.
//
// A command acts a dead time later. So the law gets the state after `preview`, with the present yaw rate. A longer
// preview, over the wheels' lag, takes a swing of the yaw rate for a turn. The angle is limited: without slip the
// centripetal acceleration is at most largest_lateral, 3 m/s^2 as in ISO 11270.
#pragma once

#include <string_view>

#include "core/strict_yaml.h"
#include "nodes/control/stanley.h"
#include "nodes/driving/command.h"
#include "nodes/driving/steering/lane.h"
#include "nodes/host/step.h"

namespace ttf::nodes::driving::steering {

struct LaneKeepingConfig {
  control::StanleyGains gains{.offset = 0.6, .yaw_rate_s = 0.15, .steering = 0.0};
  Duration preview = Duration::milliseconds(50);
  double largest_lateral = 3.0;  // [m/s^2]
  double departure_m = 0.0;      // it warns when a side is nearer to its mark than this
  LaneConfig lane;
  // The vehicle's.
  double wheelbase_m = 2.58, width_m = 1.8;
  control::AxleLoad load;
};
// Reads all but the vehicle, and where the camera measures marks.
LaneKeepingConfig load_lane_keeping(YamlMap& yaml);

// Ports `marks` and `odometry` -> `command`. The actuator takes its steering angle alone. Without a view of the lane
// the command is invalid, and the warning stays as it is.
class LaneKeeping final : public host::Step {
 public:
  LaneKeeping(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
              const LaneKeepingConfig& config);
  void run(host::StepContext& context) override;
  bool reads_newest(std::string_view) const override { return true; }  // the newest marks are the lane

 private:
  double steering_for(const Lane& lane) const;

  LaneKeepingConfig config_;
  OwnLane lane_;
  CommandOutput out_;
  bool departs_ = false;
};

}  // namespace ttf::nodes::driving::steering
