#include "nodes/host/sensor_ends.h"

#include <algorithm>
#include <functional>

#include "core/check.h"
#include "core/random.h"

namespace ttf::nodes::host {
namespace {

template <class Wanted>
std::optional<std::size_t> first_task(const schedules::model::Node& node, const Wanted& wanted) {
  const auto found = std::find_if(node.tasks.begin(), node.tasks.end(), wanted);
  if (found == node.tasks.end()) return std::nullopt;
  return static_cast<std::size_t>(found - node.tasks.begin());
}

std::size_t measuring_task(const schedules::model::Node& node, const schedules::model::Sensor& sensor, SensorId id) {
  const auto task = first_task(node, [&](const schedules::model::Task& one) {
    return one.activation.kind == schedules::model::ActivationKind::kSensor && one.activation.sensor == id;
  });
  TTF_CHECK(task.has_value(), "{} has no measuring task for {}", node.name, sensor.name);
  return *task;
}

std::size_t followed_task(const schedules::model::Node& node, const schedules::model::Sensor& sensor) {
  const auto task = first_task(node, [&](const schedules::model::Task& one) { return one.name == sensor.after; });
  TTF_CHECK(task.has_value(), "{} has no task {} for {}", node.name, sensor.after, sensor.name);
  return *task;
}

Duration phase_of(const schedules::model::Sensor& sensor, SensorId id, const PhaseKey& key) {
  if (sensor.scheduled || !sensor.instants.empty()) return {};
  if (sensor.phase) return *sensor.phase;
  RandomStream phase({key.seed, key.replication, Purpose::kSensorPhase, static_cast<std::uint16_t>(index_of(id)), 0});
  return Duration{phase.integer(0, sensor.period.ns - 1)};
}

}  // namespace

SensorEnds::SensorEnds(const schedules::model::Cluster& cluster, NodeId node, const PhaseKey& key, const NodeTime& time,
                       SensorLines& lines)
    : time_(time), lines_(lines), strobes_(cluster.sensors.size()) {
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s) {
    const schedules::model::Sensor& sensor = cluster.sensors[s];
    End end{static_cast<SensorId>(s), &sensor, std::nullopt, std::nullopt};
    if (sensor.device == node) {
      Device device;
      device.task = measuring_task(cluster.node(node), sensor, end.id);
      device.runs_freely = !sensor.scheduled && !sensor.follows();
      device.phase = phase_of(sensor, end.id, key);
      end.device = device;
    }
    if (sensor.host == node) {
      Host host;
      if (sensor.follows()) host.after = followed_task(cluster.node(node), sensor);
      end.host = host;
    }
    if (end.device || end.host) ends_.push_back(end);
  }
  set_off_.reserve(ends_.size());
}

void SensorEnds::power_on(Microticks now, Microticks first_cycle) {
  for (End& end : ends_) {
    if (!end.device) continue;
    const std::vector<Duration>& instants = end.sensor->instants;
    end.device->first = time_.oscillator().local_time(instants.empty() ? now : first_cycle) + end.device->phase;
    while (end.device->measured < instants.size() && next_by_itself(end) < now) ++end.device->measured;
    if (end.sensor->follows()) end.device->due = time_.ticks(end.device->first - LocalTime{});
  }
}

void SensorEnds::arm(std::int64_t cycle) {
  for (End& end : ends_)
    if (end.host) end.host->armed = end.sensor->scheduled && in_cycle(end.sensor->at, cycle);
}

void SensorEnds::disarm() {
  for (End& end : ends_)
    if (end.host) end.host->armed = false;
}

Microticks SensorEnds::next_by_itself(const End& end) const {
  const std::vector<Duration>& instants = end.sensor->instants;
  if (!instants.empty() && end.device->measured >= instants.size()) return kNever<Microticks>;
  const Duration since = instants.empty() ? end.sensor->period * end.device->measured : instants[end.device->measured];
  return time_.ticks((end.device->first - LocalTime{}) + since);
}

std::span<const std::size_t> SensorEnds::act(Microticks now) {
  set_off_.clear();
  for (End& end : ends_) {
    if (end.host && end.host->armed && time_.global()->start_of(end.sensor->at.offset) <= now) {
      end.host->armed = false;
      lines_.trigger(end.id);
    }
    if (!end.device) continue;
    const bool by_itself = end.device->runs_freely && next_by_itself(end) <= now;
    const bool due = end.device->due && *end.device->due <= now;
    if (due) end.device->due.reset();
    if (by_itself || due) measure(end, now);
  }
  return set_off_;
}

void SensorEnds::measure(End& end, Microticks now) {
  Device& device = *end.device;
  lines_.strobe(end.id, device.measured);
  ++device.measured;
  if (end.sensor->follows()) {
    device.ready = now + time_.ticks(end.sensor->period);
    device.due = now + time_.ticks(end.sensor->longest);
  }
  set_off_.push_back(device.task);
}

Microticks SensorEnds::next_event() const {
  Microticks next = kNever<Microticks>;
  const timebase::CycleClock* const global = time_.global();
  for (const End& end : ends_) {
    if (global != nullptr && end.host && end.host->armed)
      next = std::min(next, global->start_of(end.sensor->at.offset));
    if (!end.device) continue;
    if (end.device->due) next = std::min(next, *end.device->due);
    if (end.device->runs_freely) next = std::min(next, next_by_itself(end));
  }
  return next;
}

void SensorEnds::triggered(SensorId sensor, Microticks now) {
  for (End& end : ends_)
    if (end.id == sensor && end.device)
      end.device->due = end.sensor->follows() ? std::max(now, end.device->ready) : now;
}

void SensorEnds::latch(SensorId sensor, std::uint32_t sequence, Microticks now) {
  // Without global time a measurement has no time: its strobe counts as not seen.
  const timebase::CycleClock* global = time_.global();
  if (global == nullptr) return;
  // In real time the host may receive a strobe after the cycle in which it came.
  const Microticks since = std::max(now, global->cycle_start());
  const Duration before{(since - now).value * time_.oscillator().nominal_period_ps() / 1000};
  strobes_[index_of(sensor)].strobe(sequence, global->global_time(since) - before);
}

void SensorEnds::task_ended(std::size_t task) {
  for (const End& end : ends_)
    if (end.host && end.host->after == task) lines_.trigger(end.id);
}

bool SensorEnds::any_triggered() const {
  return std::any_of(ends_.begin(), ends_.end(), [](const End& end) { return end.device && !end.device->runs_freely; });
}

std::uint32_t SensorEnds::measurement(std::size_t task) const {
  for (const End& end : ends_)
    if (end.device && end.device->task == task && end.device->measured > 0) return end.device->measured - 1;
  return 0;
}

}  // namespace ttf::nodes::host
