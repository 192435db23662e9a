#include "nodes/host/node_clock.h"

#include "core/random.h"

namespace ttf::nodes::host {

timebase::Oscillator drawn_oscillator(const schedules::model::Node& node, std::size_t index, std::uint64_t seed,
                                      std::uint32_t replication) {
  const auto entity = static_cast<std::uint16_t>(index);
  RandomStream drift({seed, replication, Purpose::kClockDrift, entity, 0});
  RandomStream phase({seed, replication, Purpose::kClockPhase, entity, 0});
  const std::int64_t ppb = node.drift_ppb ? *node.drift_ppb : drift.integer(-node.max_drift_ppb, node.max_drift_ppb);
  return {node.microtick_ps, ppb, phase.integer(0, node.microtick_ps - 1)};
}

bus::controller::InitialClock integrated_clock(const timebase::Oscillator& oscillator,
                                               const schedules::model::Cluster& cluster,
                                               const schedules::model::Node& node, TrueTime first_cycle) {
  bus::controller::InitialClock clock;
  clock.cycle_start = oscillator.ticks_at(first_cycle) + Microticks{1};
  // The ticks of a thousand cycles: the only error is rounding to one microtick per cycle.
  const std::int64_t thousand =
      (oscillator.ticks_at(first_cycle + cluster.cycle() * 1000) - oscillator.ticks_at(first_cycle)).value;
  if (cluster.synchronisation) clock.rate = static_cast<int>((thousand + 500) / 1000 - node.flexray->pMicroPerCycle);
  return clock;
}

}  // namespace ttf::nodes::host
