#include "nodes/driving/steering/commands.h"

#include <algorithm>
#include <cmath>

namespace ttf::nodes::driving::steering {

using recording::records::CommandTaken;

bool Demand::alone(const sim::world::vehicle::ActuatorConfig& config, LocalTime now) const {
  return since_ && now - *since_ >= config.after;
}

double Demand::value(const sim::world::vehicle::ActuatorConfig& config, LocalTime now) const {
  if (config.without != sim::world::vehicle::WithoutCommand::kDecay || !alone(config, now)) return value_;
  const Duration since = now - *since_ - config.after;
  return value_ * std::exp(-since.seconds() / config.decay.seconds());
}

LateralCommands::LateralCommands(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                                 std::size_t input, const sim::world::vehicle::ActuatorConfig& config)
    : config_(config), input_(cluster, task, input, config.oldest) {}

CommandTaken LateralCommands::combine(host::StepContext& context) {
  const LocalTime now = context.stamp.local;
  pull_.execute(now);
  wheels_.execute(now);
  const CommandTaken taken = input_.read(context).taken;
  const bool steers = taken.verdict == recording::records::CommandVerdict::kApplied;
  if (context.actuation) pull_.accept(context.actuation->acceleration, now);
  if (steers) wheels_.accept(taken.steering, now);
  if (!context.actuation && !steers) return taken;
  double acceleration = pull_.value(config_, now);
  const bool brakes = config_.without == sim::world::vehicle::WithoutCommand::kBrake;
  if (brakes && pull_.alone(config_, now)) acceleration = -config_.deceleration;
  if (brakes && wheels_.alone(config_, now)) acceleration = std::min(acceleration, -config_.deceleration);
  const TrueTime from = context.stamp.true_time + config_.dead_time;
  context.actuation = host::Actuation{from, acceleration, wheels_.value(config_, now)};
  return taken;
}

}  // namespace ttf::nodes::driving::steering
