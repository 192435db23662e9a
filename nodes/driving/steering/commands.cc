#include "nodes/driving/steering/commands.h"

#include <algorithm>

namespace ttf::nodes::driving::steering {

using recording::records::CommandTaken;

LateralCommands::LateralCommands(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                                 std::size_t input, const sim::world::vehicle::ActuatorConfig& config)
    : config_(config), round_(cluster.round()), input_(input),
      signals_(bind_command(cluster, cluster.pdu(task.reads[input].pdu))) {}

// The rules are those of the other commands (actuator.h).
CommandTaken LateralCommands::read(host::StepContext& context) const {
  host::Input& input = context.inputs[input_];
  CommandTaken taken;
  taken.stamp = context.stamp;
  taken.pdu = input.pdu;
  taken.verdict = recording::records::kNoNewCommand;
  if (!input.fresh) return taken;
  taken.sequence = input.list->sequence;
  const Command command = decode_command(*input.layout, *input.list, signals_);
  taken.steering = command.steering;
  const GlobalTime issued = host::past_time_stamp(*input.layout, *input.list, context.stamp.global, round_);
  const Duration age = context.stamp.global - issued;
  if (!context.global_time || age > config_.oldest || -age > config_.oldest) {
    taken.verdict = recording::records::kLateCommand;
    input.discarded = true;
  } else {
    taken.verdict = command.valid ? recording::records::kApplied : recording::records::kInvalidCommand;
  }
  return taken;
}

CommandTaken LateralCommands::combine(host::StepContext& context) {
  const LocalTime now = context.stamp.local;
  pull_.execute(now);
  wheels_.execute(now);
  CommandTaken taken = read(context);
  const bool steers = taken.verdict == recording::records::kApplied;
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
