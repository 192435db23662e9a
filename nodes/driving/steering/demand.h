// The demand on one axis of a vehicle: on engine and brakes, or on the steering. It is the newest command's value. It
// has an age of its own, since commands may cease for one axis alone (sim/world/vehicle/actuator.h).
#pragma once

#include <optional>

#include "core/time.h"
#include "sim/world/vehicle/actuator.h"

namespace ttf::nodes::driving::steering {

class Demand {
 public:
  void accept(double value, LocalTime now) { newest_ = Newest{value, now}; }
  // Returns whether commands came and have ceased for the time `after`.
  bool alone(const sim::world::vehicle::ActuatorConfig& config, LocalTime now) const;
  // Returns the newest value. With `decay` it fades after that time. It is 0 before the first command.
  double value(const sim::world::vehicle::ActuatorConfig& config, LocalTime now) const;

 private:
  struct Newest {
    double value;
    LocalTime at;
  };
  std::optional<Newest> newest_;
};

}  // namespace ttf::nodes::driving::steering
