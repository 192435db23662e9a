// Low-level control: turns a planned speed into an acceleration, and keeps the vehicle on the line that it started on.
//
// Lengthwise it is a proportional and integral controller (nodes/control/proportional_integral.h), sideways Stanley's
// (nodes/control/stanley.h). The bus has no measured angle of the wheels: the last two commands stand for it. The line
// is straight, and the place beside it is that of odometry (own_place.h).
#pragma once

#include <optional>
#include <string_view>

#include "core/strict_yaml.h"
#include "nodes/control/proportional_integral.h"
#include "nodes/control/stanley.h"
#include "nodes/driving/command.h"
#include "nodes/driving/own_place.h"
#include "nodes/driving/plan.h"
#include "nodes/host/step.h"

namespace ttf::nodes::driving {

struct ControlConfig {
  // The tracking time is kp / ki: the integral follows the command to its limit. So the brakes do not let go as the
  // vehicle comes to a standstill.
  control::ProportionalIntegral speed{2.5, 1.0, 2.5, -6.0, 3.0};
  control::StanleyGains steering;
  double wheelbase_m = 2.6;
  Duration max_plan_age = Duration::milliseconds(100);
};
// Reads all but the wheelbase.
ControlConfig load_control(YamlMap& yaml);

// Ports `plan` and `odometry` -> `command`. Each execution issues a command. It is invalid without a valid plan that is
// young enough, and without odometry; the integral begins at zero afterwards. So it does after executions that did not
// happen, as without global time, for longer than a plan lives.
class VehicleControl final : public host::Step {
 public:
  VehicleControl(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                 const ControlConfig& config);
  void run(host::StepContext& context) override;
  bool reads_newest(std::string_view) const override { return true; }

 private:
  double steering(const PoseOnLine& own);

  ControlConfig config_;
  Duration round_;
  Duration longest_;      // between two executions without a gap
  std::size_t plan_ = 0;  // the port's place among the inputs
  PlanSignals signals_;
  OwnPlace place_;
  CommandOutput out_;
  GlobalTime issued_{};  // the newest plan
  double integral_ = 0.0;
  double steering_before_ = 0.0, steering_now_ = 0.0;  // [rad], the last two commands
  LocalTime last_{};                                   // the last execution
};

}  // namespace ttf::nodes::driving
