// The demand on one axis of a vehicle: on engine and brakes, or on the steering. It is the newest command's value. It
// has an age of its own, since commands may cease for one axis alone, or never begin (sim/world/vehicle/actuator.h).
#pragma once

#include <optional>

#include "core/time.h"
#include "sim/world/vehicle/actuator.h"

namespace ttf::nodes::driving::steering {

class Demand {
 public:
  // Tells of an execution of the actuator, before all else of it. Silence counts from the first one on.
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

}  // namespace ttf::nodes::driving::steering
