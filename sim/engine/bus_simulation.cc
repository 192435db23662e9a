#include "sim/engine/bus_simulation.h"

#include "core/check.h"
#include "sim/engine/clock_spread.h"

namespace ttf::sim::engine {
namespace {

// Returns the first cycle of the first node that begins integrated; nothing if all are powered on.
std::optional<Engine::FirstCycle> first_cycle(const schedules::model::Cluster& cluster,
                                              const std::vector<BusNode>& nodes) {
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const BusNode& node = nodes[n];
    if (!node.clock) continue;
    const Microticks start = node.clock->cycle_start;
    const Microticks length{cluster.nodes[n].flexray->pMicroPerCycle + node.clock->rate};
    const TrueTime starts = node.oscillator.time_of(start);
    return Engine::FirstCycle{starts, node.oscillator.time_of(start + length) - starts};
  }
  return std::nullopt;
}

}  // namespace

BusSimulation::BusSimulation(const schedules::model::Cluster& cluster, std::vector<BusNode> nodes,
                             std::vector<bus::controller::ControllerEvents*> events,
                             const std::vector<timebase::Oscillator>& guardians)
    : EngineOf(cluster, 0), events_(std::move(events)) {
  TTF_CHECK(nodes.size() == cluster.nodes.size() && events_.size() == nodes.size(), "{} nodes, {} events for {}",
            nodes.size(), events_.size(), cluster.nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const BusNode& node = nodes[n];
    ports_.push_back(std::make_unique<EnginePort>(*this, static_cast<NodeId>(n)));
    views_.push_back(node.view != nullptr ? node.view : &cluster);
    make_controller(n);
    seat(node.oscillator, node.clock ? std::nullopt : std::optional(node.power_on));
    if (!node.clock) continue;
    nodes_[n]->start_integrated(*node.clock);
    refresh(n);
  }
  const auto crystal = [&](schedules::model::Channel channel) {
    const auto c = index_of(channel);
    return c < guardians.size() ? guardians[c]
                                : timebase::Oscillator(medium::StarCoupler::microtick_ps(cluster_, channel), 0, 0);
  };
  seat_guardians(crystal, first_cycle(cluster, nodes));
}

BusSimulation::~BusSimulation() = default;

void BusSimulation::make_controller(std::size_t node) {
  nodes_[node] = std::make_unique<bus::controller::FlexRayController>(*views_[node], static_cast<NodeId>(node),
                                                                      *ports_[node], *events_[node]);
}

void BusSimulation::start(std::size_t node, Microticks now) { nodes_[node]->start_cold(now); }
void BusSimulation::stop(std::size_t node) { make_controller(node); }
void BusSimulation::happen(const medium::MediumEvent& event) {
  TTF_CHECK(false, "an event of kind {} without hosts", static_cast<int>(event.kind));
}

Duration BusSimulation::precision(NodeId first) const {
  ClockSpread spread(cluster_);
  for (std::size_t n = index_of(first); n < nodes_.size(); ++n)
    if (is_powered(n) && nodes_[n]->synchronised()) spread.add(nodes_[n]->clock()->global_time(ticks(n)));
  return spread.width();
}

}  // namespace ttf::sim::engine
