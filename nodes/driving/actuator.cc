#include "nodes/driving/actuator.h"

namespace ttf::nodes::driving {

using recording::records::CommandTaken;

Actuator::Actuator(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                   const sim::world::vehicle::ActuatorConfig& config)
    : config_(config), round_(cluster.round()) {
  for (std::size_t i = 0; i < task.reads.size(); ++i) {
    if (task.reads[i].port == "lateral") lateral_.emplace(cluster, task, i, config);
    const Port port{i, bind_command(cluster, cluster.pdu(task.reads[i].pdu))};
    if (task.reads[i].port == "command") command_ = port;
    if (task.reads[i].port == "emergency") emergency_ = port;
  }
}

CommandTaken Actuator::read(host::StepContext& context, const Port& port) const {
  host::Input& input = context.inputs[port.input];
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
  const Duration age = context.stamp.global - issued;
  if (!context.global_time || age > config_.oldest || -age > config_.oldest) {
    taken.verdict = recording::records::kLateCommand;
    input.discarded = true;
  } else {
    taken.verdict = command.valid ? recording::records::kApplied : recording::records::kInvalidCommand;
  }
  return taken;
}

void Actuator::run(host::StepContext& context) {
  run_longitudinal(context);
  if (lateral_) lateral_->combine(context);
}

void Actuator::run_longitudinal(host::StepContext& context) {
  CommandTaken taken = read(context, command_);
  if (taken.verdict == recording::records::kApplied) steering_ = taken.steering;
  if (emergency_) {
    const CommandTaken emergency = read(context, *emergency_);
    const bool stronger = taken.verdict != recording::records::kApplied || emergency.acceleration < taken.acceleration;
    if (emergency.verdict == recording::records::kApplied && stronger) {
      taken = emergency;
      taken.steering = steering_;
    }
  }
  if (taken.verdict == recording::records::kApplied) {
    taken.from = context.stamp.true_time + config_.dead_time;
    context.actuation = host::Actuation{taken.from, taken.acceleration, taken.steering};
  }
  context.sink->on(taken);
}

}  // namespace ttf::nodes::driving
