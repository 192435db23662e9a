#include "nodes/driving/command.h"

#include "nodes/host/signals.h"

namespace ttf::nodes::driving {

using recording::records::CommandTaken;
using recording::records::CommandVerdict;

CommandSignals bind_command(const schedules::model::Cluster& cluster, const schedules::model::PduLayout& layout) {
  return host::bind_element<3>(cluster, layout, {"valid", "acceleration", "steering"});
}

Command decode_command(const schedules::model::PduLayout& layout, const bus::cni::ListView& list,
                       const CommandSignals& signals) {
  if (host::element_count(layout, list) == 0) return {};
  const auto value = [&](std::size_t signal) { return host::element_value(layout, list, 0, signals[signal]); };
  return {value(0) != 0.0, value(1), value(2)};
}

CommandOutput::CommandOutput(const schedules::model::Cluster& cluster, const schedules::model::Task& task)
    : signals_(bind_command(cluster, cluster.pdu(host::binding_of(task.writes, "command").pdu))) {}

void CommandOutput::issue(host::StepContext& context, const Command& command,
                          recording::records::CommandIssued record) {
  host::Output& out = context.outputs[0];
  out.begin(sequence_, 1, context.stamp.global);
  out.set(0, signals_[0], command.valid ? 1.0 : 0.0);
  out.set(0, signals_[1], command.acceleration);
  out.set(0, signals_[2], command.steering);
  const Command sent = decode_command(out.layout(), out.view(), signals_);
  record.stamp = context.stamp;
  record.pdu = out.pdu();
  record.sequence = sequence_++;
  record.valid = sent.valid;
  record.acceleration = sent.acceleration;
  record.steering = sent.steering;
  context.sink->on(record);
}

CommandInput::CommandInput(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                           std::size_t input, Duration oldest)
    : input_(input), signals_(bind_command(cluster, cluster.pdu(task.reads[input].pdu))), round_(cluster.round()),
      oldest_(oldest) {}

bool CommandInput::is_old(const host::StepContext& context, GlobalTime issued) const {
  const Duration age = context.stamp.global - issued;
  return !context.global_time || age > oldest_ || -age > oldest_;
}

CommandInput::Reading CommandInput::read(host::StepContext& context) const {
  host::Input& input = context.inputs[input_];
  Reading reading;
  CommandTaken& taken = reading.taken;
  taken.stamp = context.stamp;
  taken.pdu = input.pdu;
  taken.verdict = CommandVerdict::kNoneNew;
  if (!input.fresh) return reading;
  taken.sequence = input.list->sequence;
  const Command command = decode_command(*input.layout, *input.list, signals_);
  taken.acceleration = command.acceleration;
  taken.steering = command.steering;
  reading.issued = host::past_time_stamp(*input.layout, *input.list, context.stamp.global, round_);
  if (is_old(context, reading.issued)) {
    taken.verdict = CommandVerdict::kLate;
    input.discarded = true;
  } else {
    taken.verdict = command.valid ? CommandVerdict::kApplied : CommandVerdict::kInvalid;
  }
  return reading;
}

}  // namespace ttf::nodes::driving
