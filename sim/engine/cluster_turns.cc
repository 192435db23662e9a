// A cluster with one node simulated here, and the acts outside the buses: the wires between sensors and their hosts.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/check.h"
#include "sim/engine/cluster_simulation.h"

namespace ttf::sim::engine {

// The own node may work before its turn; the others do not notice it.
void ClusterSimulation::take_turn(std::size_t node, Microticks now) {
  const auto id = static_cast<NodeId>(node);
  if (is_here(node)) {
    nodes_[node]->advance(now);
    if (now >= others_->outlook(node).turn())
      others_->speak(now, nodes_[node]->promise());
    else
      TTF_CHECK(others_->silent(), "{} breaks its promise at {} uT", cluster_.node(id).name, now.value);
    return;
  }
  if (now < others_->outlook(node).turn()) return;
  const auto acts = others_->listen(id, now);
  if (!acts) return power_off(id);
  for (const processes::Act& one : *acts) act(node, one);
}

void ClusterSimulation::act(std::size_t node, const processes::Act& act) {
  const auto id = static_cast<NodeId>(node);
  if (const auto* sent = std::get_if<bus::ports::Transmission>(&act)) {
    transmit(node, *sent);
  } else if (const auto* can = std::get_if<processes::CanAct>(&act)) {
    if (can_ports_[node][can->bus] == nullptr)
      throw std::runtime_error(fmt::format("{} sends on {}, to which it is not connected", cluster_.node(id).name,
                                           cluster_.can_buses[can->bus].name));
    send_can(can->bus, id, can->frame);
  } else if (const auto* trigger = std::get_if<processes::TriggerAct>(&act)) {
    pull_trigger(trigger->sensor);
  } else if (const auto* strobe = std::get_if<processes::StrobeAct>(&act)) {
    pull_strobe(strobe->sensor, strobe->sequence);
  } else if (const auto* actuation = std::get_if<nodes::host::Actuation>(&act)) {
    if (actuation->from <= std::max(now(), reported_from_))
      throw std::runtime_error(fmt::format("{} tells of an actuation from {} ns on, at {} ns, after one from {} ns on",
                                           cluster_.node(id).name, actuation->from.ns, now().ns, reported_from_.ns));
    reported_from_ = actuation->from;
    if (config_.actuate) config_.actuate(*actuation);
  }
}

void ClusterSimulation::actuate(const nodes::host::Actuation& actuation) {
  if (others_ != nullptr) others_->does(actuation);
  if (config_.actuate) config_.actuate(actuation);
}

void ClusterSimulation::trigger(SensorId sensor) {
  if (others_ != nullptr) others_->does(processes::TriggerAct{sensor});
  pull_trigger(sensor);
}

void ClusterSimulation::strobe(SensorId sensor, std::uint32_t sequence) {
  if (others_ != nullptr) others_->does(processes::StrobeAct{sensor, sequence});
  pull_strobe(sensor, sequence);
}

void ClusterSimulation::pull_trigger(SensorId sensor) {
  medium::MediumEvent event;
  event.kind = medium::MediumEvent::Kind::kTrigger;
  event.node = static_cast<std::uint8_t>(cluster_.sensor(sensor).device);
  event.sensor = static_cast<std::uint8_t>(sensor);
  queue_.schedule(now(), medium::Phase::kArrival, event.node, event);
}

void ClusterSimulation::pull_strobe(SensorId sensor, std::uint32_t sequence) {
  medium::MediumEvent event;
  event.kind = medium::MediumEvent::Kind::kStrobe;
  event.node = static_cast<std::uint8_t>(cluster_.sensor(sensor).host);
  event.sensor = static_cast<std::uint8_t>(sensor);
  event.identifier = sequence;
  queue_.schedule(now(), medium::Phase::kArrival, event.node, event);
}

}  // namespace ttf::sim::engine
