// The steering of a vehicle that has commands of its own for it, beside those of engine and brakes.
//
// Each of the two axes has an age of its own (demand.h). If one of them gets a command, the actuation has the other's
// last value. An axis without commands for the time `after`, since the actuator's first execution, too, reacts as the
// actuator's file says. It holds its value, or lets it fade. Or the vehicle brakes, with the wheels as they were asked
// for. If neither axis gets a command, there is no actuation.
#pragma once

#include <cstddef>

#include "nodes/driving/command.h"
#include "nodes/driving/steering/demand.h"
#include "nodes/host/step.h"
#include "sim/world/vehicle/actuator.h"

namespace ttf::nodes::driving::steering {

class LateralCommands {
 public:
  // `input` is the place of the port `lateral` among the task's.
  LateralCommands(const schedules::model::Cluster& cluster, const schedules::model::Task& task, std::size_t input,
                  const sim::world::vehicle::ActuatorConfig& config);
  // Reads the list, and returns the verdict. Puts it together with the step's actuation: that of engine and brakes, or
  // none.
  recording::records::CommandTaken combine(host::StepContext& context);

 private:
  sim::world::vehicle::ActuatorConfig config_;
  CommandInput input_;
  Demand pull_, wheels_;
};

}  // namespace ttf::nodes::driving::steering
