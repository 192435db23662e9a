#include "nodes/driving/steering/demand.h"

#include <cmath>

namespace ttf::nodes::driving::steering {

bool Demand::alone(const sim::world::vehicle::ActuatorConfig& config, LocalTime now) const {
  return newest_ && now - newest_->at >= config.after;
}

double Demand::value(const sim::world::vehicle::ActuatorConfig& config, LocalTime now) const {
  if (!newest_) return 0.0;
  if (config.without != sim::world::vehicle::WithoutCommand::kDecay || !alone(config, now)) return newest_->value;
  const Duration since = now - newest_->at - config.after;
  return newest_->value * std::exp(-since.seconds() / config.decay.seconds());
}

}  // namespace ttf::nodes::driving::steering
