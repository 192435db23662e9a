#include "nodes/driving/steering/demand.h"

#include <cmath>

namespace ttf::nodes::driving::steering {

bool Demand::alone(const sim::world::vehicle::ActuatorConfig& config, LocalTime now) const {
  return since_ && now - *since_ >= config.after;
}

double Demand::value(const sim::world::vehicle::ActuatorConfig& config, LocalTime now) const {
  if (config.without != sim::world::vehicle::WithoutCommand::kDecay || !alone(config, now)) return value_;
  const Duration since = now - *since_ - config.after;
  return value_ * std::exp(-since.seconds() / config.decay.seconds());
}

}  // namespace ttf::nodes::driving::steering
