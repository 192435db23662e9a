#include "sim/crank/bus_simulation.h"

#include <algorithm>

#include "core/check.h"
#include "sim/crank/clock_spread.h"

namespace ttf::sim::crank {

BusSimulation::BusSimulation(const schedules::model::Cluster& cluster, std::vector<BusNode> nodes,
                             std::vector<bus::controller::ControllerEvents*> events,
                             const std::vector<timebase::Oscillator>& guardians)
    : Crank(cluster, 0), events_(std::move(events)) {
  TTF_CHECK(nodes.size() == cluster.nodes.size() && events_.size() == nodes.size(), "{} nodes, {} events for {}",
            nodes.size(), events_.size(), cluster.nodes.size());
  controllers_.resize(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const BusNode& node = nodes[n];
    ports_.push_back(std::make_unique<CrankPort>(*this, static_cast<NodeId>(n)));
    views_.push_back(node.view != nullptr ? node.view : &cluster);
    make_controller(n);
    seat(node.oscillator, node.clock ? std::nullopt : std::optional(node.power_on));
    if (!node.clock) continue;
    controllers_[n]->start_integrated(*node.clock);
    refresh(n);
  }
  if (cluster.guardian) make_guardians(nodes, guardians);
}

BusSimulation::~BusSimulation() = default;

void BusSimulation::make_controller(std::size_t node) {
  controllers_[node] = std::make_unique<bus::controller::FlexRayController>(*views_[node], static_cast<NodeId>(node),
                                                                            *ports_[node], *events_[node]);
}

void BusSimulation::make_guardians(const std::vector<BusNode>& nodes,
                                   const std::vector<timebase::Oscillator>& oscillators) {
  const auto integrated =
      std::find_if(nodes.begin(), nodes.end(), [](const BusNode& node) { return node.clock.has_value(); });
  for (const schedules::model::Channel channel : {schedules::model::Channel::kA, schedules::model::Channel::kB}) {
    if (!medium::StarCoupler::needed(cluster_, channel)) continue;
    seat_guardian(channel, index_of(channel) < oscillators.size()
                               ? oscillators[index_of(channel)]
                               : timebase::Oscillator(medium::StarCoupler::microtick_ps(cluster_, channel), 0, 0));
    if (integrated == nodes.end()) continue;
    // On that node's clock.
    const auto& p = *cluster_.nodes[static_cast<std::size_t>(integrated - nodes.begin())].flexray;
    const Microticks start = integrated->clock->cycle_start;
    const Microticks cycle{p.pMicroPerCycle + integrated->clock->rate};
    const TrueTime first = integrated->oscillator.time_of(start);
    coupler(channel)->start_integrated(first, integrated->oscillator.time_of(start + cycle) - first);
  }
}

void BusSimulation::start(std::size_t node, Microticks now) { controllers_[node]->start_cold(now); }
void BusSimulation::stop(std::size_t node) { make_controller(node); }
Microticks BusSimulation::next_event(std::size_t node) const { return controllers_[node]->next_event(); }
void BusSimulation::advance(std::size_t node, Microticks now) { controllers_[node]->advance(now); }
void BusSimulation::receive(std::size_t node, const bus::ports::Reception& reception) {
  controllers_[node]->receive(reception);
}
bool BusSimulation::receive_on_both(std::size_t node, const bus::ports::Reception& reception) {
  return controllers_[node]->receive_on_both(reception);
}
void BusSimulation::happen(const medium::MediumEvent& event) {
  TTF_CHECK(false, "an event of kind {} without hosts", static_cast<int>(event.kind));
}

Duration BusSimulation::precision(NodeId first) const {
  ClockSpread spread(cluster_);
  for (std::size_t n = index_of(first); n < controllers_.size(); ++n)
    if (is_powered(n) && controllers_[n]->synchronised()) spread.add(controllers_[n]->clock()->global_time(ticks(n)));
  return spread.width();
}

}  // namespace ttf::sim::crank
