#include "nodes/driving/plan.h"

#include "nodes/host/signals.h"

namespace ttf::nodes::driving {

PlanSignals bind_plan(const schedules::model::Cluster& cluster, const schedules::model::PduLayout& layout) {
  return host::bind_element<4>(cluster, layout, {"valid", "speed", "state", "id"});
}

Plan decode_plan(const schedules::model::PduLayout& layout, const bus::cni::ListView& list,
                 const PlanSignals& signals) {
  if (host::element_count(layout, list) == 0) return {};
  const auto value = [&](std::size_t signal) { return host::element_value(layout, list, 0, signals[signal]); };
  return {value(0) != 0.0, value(1), static_cast<recording::records::PlannerState>(value(2))};
}

PlanOutput::PlanOutput(const schedules::model::Cluster& cluster, const schedules::model::Task& task)
    : signals_(bind_plan(cluster, cluster.pdu(host::binding_of(task.writes, "plan").pdu))) {
  while (task.writes[port_].port != "plan") ++port_;
}

void PlanOutput::issue(host::StepContext& context, const Plan& plan, recording::records::PlanMade record) {
  host::Output& out = context.outputs[port_];
  out.begin(sequence_, 1, context.stamp.global);
  out.set(0, signals_[0], plan.valid ? 1.0 : 0.0);
  out.set(0, signals_[1], plan.speed);
  out.set(0, signals_[2], static_cast<double>(plan.state));
  out.set(0, signals_[3], static_cast<double>(index_of(record.track)));
  const Plan sent = decode_plan(out.layout(), out.view(), signals_);
  record.stamp = context.stamp;
  record.pdu = out.pdu();
  record.sequence = sequence_++;
  record.valid = sent.valid;
  record.speed = sent.speed;
  record.state = sent.state;
  context.sink->on(record);
}

}  // namespace ttf::nodes::driving
