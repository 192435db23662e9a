#include "schedules/left_out/periods.h"

#include <algorithm>

#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/sensor_loop.h"
#include "schedules/model/repetitions.h"

namespace ttf::schedules::left_out {
namespace {

constexpr int kAsked = -1;

}  // namespace

Periods::Periods(model::Cluster& cluster, const std::vector<std::vector<TaskParts>>& tasks)
    : cluster_(cluster), tasks_(tasks), seldom_(model::frame_repetitions(cluster.flexray).back()) {
  for (const model::Node& node : cluster_.nodes) state_.emplace_back(node.tasks.size(), 0);
}

void Periods::set(std::vector<List>& lists) {
  for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
    for (std::size_t t = 0; t < cluster_.nodes[n].tasks.size(); ++t) (void)of({static_cast<NodeId>(n), t});
  for (List& list : lists) {
    if (!list.at.repetition) continue;
    const int written = of_list(list.pdu, model::kFlexRay);
    for (const int repetition : model::frame_repetitions(cluster_.flexray))
      if (written % repetition == 0) list.repetition = repetition;
  }
}

int Periods::of(TaskId id) {
  int& known = state_[index_of(id.node)][id.task];
  if (known == kAsked) return seldom_;  // a ring: its other lists decide
  if (known != 0) return known;
  known = kAsked;
  const int found = derived(id);
  model::Task& task = cluster_.nodes[index_of(id.node)].tasks[id.task];
  if (by_time(task) && tasks_[index_of(id.node)][id.task].at.repetition) task.activation.at.repetition = found;
  return state_[index_of(id.node)][id.task] = found;
}

int Periods::of_list(PduId pdu, model::MediumId medium) {
  const auto writer = writer_of(cluster_, pdu, medium);
  return writer ? of(*writer) : seldom_;
}

int Periods::derived(TaskId id) {
  const model::Task& task = task_at(cluster_, id);
  if (task.activation.kind == model::ActivationKind::kSensor) {
    const model::Sensor& sensor = cluster_.sensor(task.activation.sensor);
    return sensor.scheduled ? sensor.at.repetition : seldom_;
  }
  if (by_time(task) && !tasks_[index_of(id.node)][id.task].at.repetition) return task.activation.at.repetition;
  int least = seldom_;
  for (const model::PortBinding& in : task.reads)
    if (task.activation.kind != model::ActivationKind::kMessage || activates(task, in))
      least = std::min(least, of_list(in.pdu, in.medium));
  if (!task.reads.empty()) return least;
  for (std::size_t t = 0; t < cluster_.node(id.node).tasks.size(); ++t)
    if (fuses(cluster_, {id.node, t})) least = std::min(least, of({id.node, t}));
  return least;
}

// The checker proves the bound (check/responses.cc).
void set_shortest_periods(model::Cluster& cluster, const std::vector<std::vector<bool>>& absent, Periods& periods) {
  const analysis::ClockBounds clocks = analysis::clock_bounds(cluster);
  for (std::size_t c = 0; c < cluster.can_buses.size(); ++c)
    for (std::size_t m = 0; m < cluster.can_buses[c].messages.size(); ++m) {
      if (!absent[c][m]) continue;
      model::CanMessage& message = cluster.can_buses[c].messages[m];
      const Duration period = cluster.cycle() * periods.of_list(message.pdu, model::MediumId::can(c));
      Duration varies = Duration::microseconds(100);
      for (const model::Task& task : cluster.node(message.sender).tasks)
        for (const model::PortBinding& out : task.writes)
          if (out.pdu == message.pdu) varies += task.worst_case - analysis::shortest_execution(task);
      const std::int64_t least = period.ns - 2 * clocks.drift_ns(period.ns) - varies.ns;
      message.shortest_period = {std::max<std::int64_t>(100'000, least / 10'000 * 10'000)};
    }
}

}  // namespace ttf::schedules::left_out
