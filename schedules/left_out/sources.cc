#include "schedules/left_out/sources.h"

#include <algorithm>
#include <utility>

#include "core/int128.h"
#include "schedules/analysis/can_load.h"
#include "schedules/analysis/responses.h"
#include "schedules/model/round.h"
#include "schedules/model/wire_times.h"

namespace ttf::schedules::left_out {
namespace {

constexpr int kMostHops = 64;  // lists that lead back to their writer have no beginning

std::vector<Source> later(std::vector<Source> sources, std::int64_t ns) {
  for (Source& source : sources) source.ns += ns;
  return sources;
}

}  // namespace

Sources::Sources(const model::Cluster& cluster) : cluster_(cluster), clocks_(analysis::clock_bounds(cluster)) {}

// An execution or a transfer, as another clock may measure it (schedules/analysis/age_stages.cc).
std::int64_t Sources::span(Duration worst) const {
  return worst.ns + clocks_.drift_ns(worst.ns) + model::kGranularity_ns;
}

Duration Sources::response(TaskId id) const {
  const auto responses = analysis::worst_responses(cluster_, id.node);
  const Duration least = task_at(cluster_, id).worst_case;
  return responses ? std::max(least, (*responses)[id.task].worst) : least;
}

std::vector<Source> Sources::ready(TaskId id, int hops) const {
  const model::Task& task = task_at(cluster_, id);
  if (hops > kMostHops) return {};
  switch (task.activation.kind) {
    case model::ActivationKind::kTime:
      return {{{SchedulePlace::Kind::kTask, kNoSensor, id, kNoPdu}, span(task.worst_case)}};
    case model::ActivationKind::kSensor: {
      const SensorId sensor = task.activation.sensor;
      if (!cluster_.sensor(sensor).scheduled) return {};
      return {{{SchedulePlace::Kind::kMeasurement, sensor, {}, kNoPdu}, span(response(id))}};
    }
    case model::ActivationKind::kMessage: {
      for (const model::PortBinding& in : task.reads)
        if (activates(task, in)) return later(arrival(in.pdu, in.medium, hops + 1), span(response(id)));
      return {};
    }
    case model::ActivationKind::kModes: return {};  // its instants differ from frame to frame
    case model::ActivationKind::kCompletion: {
      const std::vector<model::Task>& tasks = cluster_.node(id.node).tasks;
      for (std::size_t t = 0; t < tasks.size(); ++t)
        if (tasks[t].name == task.activation.after) return later(ready({id.node, t}, hops + 1), span(task.worst_case));
      return {};
    }
  }
  return {};
}

std::vector<Source> Sources::arrival(PduId pdu, model::MediumId medium, int hops) const {
  if (medium.is_flexray()) return {{{SchedulePlace::Kind::kSlots, kNoSensor, {}, pdu}, 0}};
  const model::CanBus& bus = cluster_.can(medium);
  for (const model::CanMessage& message : bus.messages)
    if (message.pdu == pdu)
      if (const auto writer = writer_of(cluster_, pdu, medium))
        if (const auto worst = analysis::can_worst_response(cluster_, bus, message))
          return later(ready(*writer, hops + 1), span(*worst));
  return {};
}

Ticks ticks(const model::GlobalParameters& flexray, std::int64_t ns) {
  return model::ceil_div(static_cast<Int128>(ns) * 1'000, flexray.gdMacrotick_ps);
}

Ticks last_slot(const model::Cluster& cluster) {
  const model::GlobalParameters& g = cluster.flexray;
  if (!cluster.arrival_window) return g.gNumberOfStaticSlots;
  const Ticks late = ticks(g, cluster.arrival_window->late.ns) + g.gdActionPointOffset;
  return g.gNumberOfStaticSlots + 1 - (late + g.gdStaticSlot - 1) / g.gdStaticSlot;
}

}  // namespace ttf::schedules::left_out
