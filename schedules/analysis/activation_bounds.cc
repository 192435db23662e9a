#include "schedules/analysis/activation_bounds.h"

#include <algorithm>
#include <utility>

#include "schedules/analysis/can_load.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/responses.h"
#include "schedules/analysis/sensor_loop.h"
#include "schedules/analysis/slot_groups.h"
#include "schedules/model/round.h"

namespace ttf::schedules::analysis {
namespace {

class BoundFinder {
 public:
  BoundFinder(const model::Cluster& cluster, WritersOfLists writers)
      : cluster_(cluster), clocks_(clock_bounds(cluster)), writers_(writers) {}

  processor::ActivationBounds of(const model::Task& task) {
    if (task.activation.kind == model::ActivationKind::kSensor) measurements(task.activation.sensor);
    for (const model::PortBinding& binding : task.reads) {
      if (!activates(task, binding)) continue;
      if (binding.medium.is_can())
        over_can(cluster_.can(binding.medium), binding.pdu);
      else
        over_flexray(binding.pdu);
      break;
    }
    return std::move(found_);
  }

 private:
  // Returns the shortest time on the node's own clock for a time on other clocks.
  std::int64_t own(std::int64_t ns) const {
    return std::max<std::int64_t>(1, ns - clocks_.drift_ns(ns) - model::kGranularity_ns);
  }

  void measurements(SensorId id) {
    const model::Sensor& sensor = cluster_.sensor(id);
    if (sensor.scheduled) return found_.all.push_back({own(sensor.period.ns), clocks_.apart_ns});
    // An untriggered device counts its period on its own oscillator.
    std::int64_t period = std::max<std::int64_t>(1, sensor.period.ns - model::kGranularity_ns);
    if (const auto loop = loop_of(cluster_, id)) period = std::max(period, shortest_round(cluster_, *loop).ns);
    found_.all.push_back({period, 0});
  }

  void over_can(const model::CanBus& bus, PduId pdu) {
    for (const model::CanMessage& other : bus.messages)
      if (!can_data_length(bus.flexible_data_rate, cluster_.pdu(other.pdu).fragment_bytes)) return;
    if (can_worst_load(cluster_, bus) > kCanLoadLimit) return;
    for (const model::CanMessage& message : bus.messages) {
      if (message.pdu != pdu) continue;
      const auto worst = can_worst_response(cluster_, bus, message);
      if (!worst) return;
      const Duration best = can_soonest_arrival(bus, cluster_.pdu(pdu).fragment_bytes);
      return found_.all.push_back(
          {own(message.shortest_period.ns), std::max<std::int64_t>(0, (*worst - best).ns) + model::kGranularity_ns});
    }
  }

  void over_flexray(PduId pdu) {
    const auto slots = shortest_slot_gap(cluster_, pdu);
    if (!slots) return;
    found_.all.push_back({own(slots->gap.ns), slots->spread.ns + 2 * clocks_.apart_ns});
    if (writers_ == WritersOfLists::kUnknown) return;
    const std::int64_t sent = slots->longest.ns + slots->spread.ns;
    if (const auto written = shortest_written(pdu))
      found_.all.push_back(
          {own(written->ns), sent + clocks_.drift_ns(sent) + 2 * clocks_.apart_ns + model::kGranularity_ns});
  }

  // Returns the shortest time between two lists at their writer, on its clock.
  std::optional<Duration> shortest_written(PduId pdu) const {
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
      const std::vector<model::Task>& tasks = cluster_.nodes[n].tasks;
      for (std::size_t t = 0; t < tasks.size(); ++t)
        for (const model::PortBinding& binding : tasks[t].writes) {
          if (binding.medium.is_can() || binding.pdu != pdu) continue;
          const auto responses = worst_responses(cluster_, static_cast<NodeId>(n), WritersOfLists::kUnknown);
          return responses ? (*responses)[t].written : std::nullopt;
        }
    }
    return std::nullopt;
  }

  const model::Cluster& cluster_;
  ClockBounds clocks_;
  WritersOfLists writers_;
  processor::ActivationBounds found_;
};

}  // namespace

processor::ActivationBounds activation_bounds(const model::Cluster& cluster, const model::Task& task,
                                              WritersOfLists writers) {
  return BoundFinder(cluster, writers).of(task);
}

}  // namespace ttf::schedules::analysis
