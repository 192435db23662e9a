#include "nodes/driving/actuator.h"

namespace ttf::nodes::driving {

using recording::records::CommandTaken;

Actuator::Actuator(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                   const sim::world::vehicle::ActuatorConfig& config)
    : config_(config), round_(cluster.round()) {
  for (std::size_t i = 0; i < task.reads.size(); ++i) {
    if (task.reads[i].port == "lateral") lateral_.emplace(cluster, task, i, config);
    const Port port{i, bind_command(cluster, cluster.pdu(task.reads[i].pdu)), {}};
    if (task.reads[i].port == "command") command_ = port;
    if (task.reads[i].port == "emergency") emergency_ = port;
  }
}

bool Actuator::is_old(const host::StepContext& context, GlobalTime issued) const {
  const Duration age = context.stamp.global - issued;
  return !context.global_time || age > config_.oldest || -age > config_.oldest;
}

CommandTaken Actuator::read(host::StepContext& context, Port& port) {
  host::Input& input = context.inputs[port.input];
  if (port.living && is_old(context, port.living->issued)) port.living.reset();
  CommandTaken taken;
  taken.stamp = context.stamp;
  taken.pdu = input.pdu;
  taken.verdict = recording::records::kNoNewCommand;
  if (!input.fresh) return taken;
  taken.sequence = input.list->sequence;
  const Command command = decode_command(*input.layout, *input.list, port.signals);
  taken.acceleration = command.acceleration;
  taken.steering = command.steering;
  const GlobalTime issued = host::past_time_stamp(*input.layout, *input.list, context.stamp.global, round_);
  if (is_old(context, issued)) {
    taken.verdict = recording::records::kLateCommand;
    input.discarded = true;
    return taken;
  }
  port.living.reset();
  if (command.valid) {
    taken.verdict = recording::records::kApplied;
    port.living = Living{taken, issued};
  } else {
    // Emergency braking that does not brake says so by an invalid command.
    taken.verdict = &port == &command_ ? recording::records::kInvalidCommand : recording::records::kNothingAsked;
  }
  return taken;
}

void Actuator::run(host::StepContext& context) {
  Records records = run_longitudinal(context);
  if (lateral_) {
    const CommandTaken taken = lateral_->combine(context);
    if (taken.verdict != recording::records::kNoNewCommand) records.add(taken);
  }
  for (std::size_t i = 0; i < records.count; ++i) {
    CommandTaken& taken = records.all[i];
    if (taken.verdict == recording::records::kApplied) {
      taken.acceleration = context.actuation->acceleration;
      taken.steering = context.actuation->steering;
      taken.from = context.actuation->from;
    }
    context.sink->on(taken);
  }
}

Actuator::Records Actuator::run_longitudinal(host::StepContext& context) {
  CommandTaken taken = read(context, command_);
  if (taken.verdict == recording::records::kApplied) steering_ = taken.steering;
  std::optional<CommandTaken> emergency;
  if (emergency_) emergency = read(context, *emergency_);

  const std::optional<Living>* counts = &command_.living;
  if (emergency_ && emergency_->living &&
      (!*counts || emergency_->living->taken.acceleration < (*counts)->taken.acceleration))
    counts = &emergency_->living;
  const auto is_new = [](const CommandTaken& read) {
    return read.verdict != recording::records::kNoNewCommand && read.verdict != recording::records::kLateCommand;
  };
  const bool acts = counts->has_value() && (is_new(taken) || (emergency && is_new(*emergency)));
  Records records;
  bool told = false;
  const auto tell = [&](CommandTaken read) {
    if (read.verdict == recording::records::kApplied) {
      if (read.pdu == (*counts)->taken.pdu) {
        hand_over(context, read);
        told = true;
      } else {
        read.verdict = recording::records::kWeakerCommand;
      }
    }
    records.add(read);
  };
  tell(taken);
  if (emergency && emergency->verdict != recording::records::kNoNewCommand) tell(*emergency);
  if (!acts || told) return records;
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
