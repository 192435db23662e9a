#include "nodes/driving/actuator.h"

#include <algorithm>
#include <cmath>

namespace ttf::nodes::driving {

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

using recording::records::CommandVerdict;

Actuator::Actuator(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                   const sim::world::vehicle::ActuatorConfig& config)
    : config_(config) {
  for (std::size_t i = 0; i < task.reads.size(); ++i) {
    if (task.reads[i].port == "lateral") lateral_.emplace(cluster, task, i, config);
    if (task.reads[i].port == "command") command_ = Port{CommandInput(cluster, task, i, config.oldest)};
    if (task.reads[i].port == "emergency") emergency_ = Port{CommandInput(cluster, task, i, config.oldest)};
  }
}

CommandTaken Actuator::read(host::StepContext& context, Port& port) {
  if (port.living && port.input.is_old(context, port.living->issued)) port.living.reset();
  CommandInput::Reading reading = port.input.read(context);
  switch (reading.taken.verdict) {
    case CommandVerdict::kApplied: port.living = reading; break;
    case CommandVerdict::kInvalid:
      port.living.reset();
      // Emergency braking that does not brake says so by an invalid command.
      if (&port != &*command_) reading.taken.verdict = CommandVerdict::kNothingAsked;
      break;
    case CommandVerdict::kNoneNew:
    case CommandVerdict::kLate:
    case CommandVerdict::kNothingAsked:
    case CommandVerdict::kWeaker: break;
  }
  return reading.taken;
}

void Actuator::run(host::StepContext& context) {
  Records records = run_longitudinal(context);
  if (lateral_) {
    const CommandTaken taken = lateral_->combine(context);
    if (taken.verdict != CommandVerdict::kNoneNew) records.add(taken);
  }
  for (std::size_t i = 0; i < records.count; ++i) {
    CommandTaken& taken = records.all[i];
    if (taken.verdict == CommandVerdict::kApplied) {
      taken.acceleration = context.actuation->acceleration;
      taken.steering = context.actuation->steering;
      taken.from = context.actuation->from;
    }
    context.sink->on(taken);
  }
}

Actuator::Records Actuator::run_longitudinal(host::StepContext& context) {
  CommandTaken taken = read(context, *command_);
  if (taken.verdict == CommandVerdict::kApplied) steering_ = taken.steering;
  std::optional<CommandTaken> emergency;
  if (emergency_) emergency = read(context, *emergency_);

  const std::optional<CommandInput::Reading>* counts = &command_->living;
  if (emergency_ && emergency_->living &&
      (!*counts || emergency_->living->taken.acceleration < (*counts)->taken.acceleration))
    counts = &emergency_->living;
  const auto is_new = [](const CommandTaken& read) {
    return read.verdict != CommandVerdict::kNoneNew && read.verdict != CommandVerdict::kLate;
  };
  const bool acts = counts->has_value() && (is_new(taken) || (emergency && is_new(*emergency)));
  Records records;
  bool handed_over = false;
  const auto note = [&](CommandTaken read) {
    if (read.verdict == CommandVerdict::kApplied) {
      if (read.pdu == (*counts)->taken.pdu) {
        hand_over(context, read);
        handed_over = true;
      } else {
        read.verdict = CommandVerdict::kWeaker;
      }
    }
    records.add(read);
  };
  note(taken);
  if (emergency && emergency->verdict != CommandVerdict::kNoneNew) note(*emergency);
  if (!acts || handed_over) return records;
  CommandTaken earlier = (*counts)->taken;
  earlier.stamp = context.stamp;
  hand_over(context, earlier);
  records.add(earlier);
  return records;
}

void Actuator::hand_over(host::StepContext& context, const CommandTaken& taken) const {
  const TrueTime from = context.stamp.true_time + config_.dead_time;
  context.actuation = host::Actuation{from, taken.acceleration, steering_};
}

}  // namespace ttf::nodes::driving
