// The steering of a vehicle that has commands of its own for it, beside those of engine and brakes.
//
// Each of the two axes has an age of its own. If one of them gets a command, the actuation has the other's
// last value. An axis without commands for the time `after`, since the actuator's first execution, too, reacts as the
// actuator's file says. It holds its value, or lets it fade. Or the vehicle brakes, with the wheels as they were asked
// for. If neither axis gets a command, there is no actuation.
#pragma once

#include <cstddef>
#include <optional>

#include "core/time.h"
#include "nodes/driving/command.h"
#include "nodes/host/step.h"
#include "sim/world/vehicle/actuator.h"

namespace ttf::nodes::driving::steering {

// The demand on one axis of a vehicle: on engine and brakes, or on the steering. It is the newest command's value. It
// has an age of its own, since commands may cease for one axis alone, or never begin (sim/world/vehicle/actuator.h).
class Demand {
 public:
  // Notes an execution of the actuator, before all else of it. Silence counts from the first one on.
  void execute(LocalTime now) {
    if (!since_) since_ = now;
  }
  void accept(double value, LocalTime now) { value_ = value, since_ = now; }
  // Returns whether no command has come for the time `after`.
  bool alone(const sim::world::vehicle::ActuatorConfig& config, LocalTime now) const;
  // Returns the newest value. With `decay` it fades after that time. It is 0 before the first command.
  double value(const sim::world::vehicle::ActuatorConfig& config, LocalTime now) const;

 private:
  double value_ = 0.0;
  std::optional<LocalTime> since_;  // the newest command, or else the first execution
};

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
