#include "schedules/analysis/sensor_loop.h"

#include <algorithm>

#include "schedules/analysis/can_load.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/responses.h"
#include "schedules/model/round.h"

namespace ttf::schedules::analysis {
namespace {

Duration at_least(const model::Cluster& cluster, Duration time) {
  return {std::max<std::int64_t>(0, time.ns - clock_bounds(cluster).drift_ns(time.ns) - model::kGranularity_ns)};
}
Duration at_most(const model::Cluster& cluster, Duration time) {
  return {time.ns + clock_bounds(cluster).drift_ns(time.ns) + model::kGranularity_ns};
}

// Over FlexRay no minimum is assumed.
Duration shortest_transfer(const model::Cluster& cluster, const model::PortBinding& raw) {
  if (raw.medium.is_flexray()) return {};
  const model::CanBus& bus = cluster.can(raw.medium);
  const int bytes = cluster.pdu(raw.pdu).fragment_bytes;
  if (!can_data_length(bus.flexible_data_rate, bytes)) return {};
  return can_soonest_arrival(bus, bytes);
}

std::optional<Duration> worst_of(const model::Cluster& cluster, NodeId id, const model::Task& task) {
  return worst_response(cluster, id, static_cast<std::size_t>(&task - cluster.node(id).tasks.data()), {});
}

std::optional<Duration> longest_transfer(const model::Cluster& cluster, const model::PortBinding& raw) {
  if (raw.medium.is_flexray()) return std::nullopt;
  const model::CanBus& bus = cluster.can(raw.medium);
  for (const model::CanMessage& message : bus.messages)
    if (message.pdu == raw.pdu && can_data_length(bus.flexible_data_rate, cluster.pdu(raw.pdu).fragment_bytes))
      return can_worst_response(cluster, bus, message);
  return std::nullopt;
}

}  // namespace

std::optional<SensorLoop> loop_of(const model::Cluster& cluster, SensorId id) {
  const model::Sensor& sensor = cluster.sensor(id);
  if (!sensor.follows()) return std::nullopt;
  for (const model::Task& task : cluster.node(sensor.host).tasks)
    if (task.activation.kind == model::ActivationKind::kCompletion && task.activation.after == sensor.after)
      return std::nullopt;
  for (const model::Task& measuring : cluster.node(sensor.device).tasks) {
    if (measuring.activation.kind != model::ActivationKind::kSensor || measuring.activation.sensor != id) continue;
    for (const model::Task& after : cluster.node(sensor.host).tasks) {
      if (after.name != sensor.after) continue;
      for (const model::PortBinding& in : after.reads)
        for (const model::PortBinding& out : measuring.writes)
          if (activates(after, in) && in.pdu == out.pdu && in.medium == out.medium)
            return SensorLoop{id, &measuring, &out, &after};
    }
  }
  return std::nullopt;
}

std::optional<SensorLoop> loop_through(const model::Cluster& cluster, NodeId node, const model::Task& task) {
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s) {
    if (cluster.sensors[s].host != node || cluster.sensors[s].after != task.name) continue;
    if (const auto loop = loop_of(cluster, static_cast<SensorId>(s)); loop && loop->after == &task) return loop;
  }
  return std::nullopt;
}

Duration shortest_return(const model::Cluster& cluster, const SensorLoop& loop) {
  return at_least(cluster, shortest_execution(*loop.measuring) + shortest_transfer(cluster, *loop.raw));
}

Duration shortest_round(const model::Cluster& cluster, const SensorLoop& loop) {
  return shortest_return(cluster, loop) + at_least(cluster, shortest_execution(*loop.after));
}

std::optional<Duration> longest_round(const model::Cluster& cluster, const SensorLoop& loop) {
  const model::Sensor& sensor = cluster.sensor(loop.sensor);
  const auto measuring = worst_of(cluster, sensor.device, *loop.measuring);
  const auto sent = longest_transfer(cluster, *loop.raw);
  const auto after = worst_of(cluster, sensor.host, *loop.after);
  if (!sent || !measuring || !after) return std::nullopt;
  return std::max(at_most(cluster, *measuring + *sent + *after), at_most(cluster, sensor.period));
}

}  // namespace ttf::schedules::analysis
