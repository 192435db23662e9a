#include "sim/bus_simulation.h"

#include <algorithm>
#include <limits>

#include "core/check.h"

namespace ttf::sim {
namespace {

constexpr TrueTime kNever{std::numeric_limits<std::int64_t>::max()};
constexpr std::size_t kPendingEvents = 4096;

}  // namespace

struct BusSimulation::Port final : bus::FlexRayPort {
  BusSimulation& simulation;
  NodeId node;
  Port(BusSimulation& s, NodeId n) : simulation(s), node(n) {}
  void transmit(const bus::Transmission& transmission) override {
    const timebase::Oscillator& oscillator = simulation.oscillator(node);
    simulation.medium_.transmit(node, transmission, oscillator.time_of(transmission.start),
                                oscillator.time_of(transmission.end));
  }
  bool carrier(schedules::Channel channel) const override {
    return simulation.medium_.carrier(node, channel, simulation.now_);
  }
};

BusSimulation::BusSimulation(const schedules::Cluster& cluster, std::vector<BusNode> nodes,
                             std::vector<bus::ControllerEvents*> events)
    : cluster_(cluster),
      nodes_(std::move(nodes)),
      events_(std::move(events)),
      queue_(kPendingEvents),
      pool_(kPendingEvents),
      medium_(cluster, queue_, pool_),
      powered_(cluster.nodes.size(), false) {
  TTF_CHECK(nodes_.size() == cluster.nodes.size() && events_.size() == nodes_.size(), "{} nodes, {} events for {}",
            nodes_.size(), events_.size(), cluster.nodes.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const auto id = static_cast<NodeId>(n);
    ports_.push_back(std::make_unique<Port>(*this, id));
    controllers_.push_back(std::make_unique<bus::FlexRayController>(cluster_, id, *ports_[n], *events_[n]));
    next_.push_back(nodes_[n].power_on);
  }
}

BusSimulation::~BusSimulation() = default;

void BusSimulation::set_disturbance(Disturbance* disturbance) {
  disturbance_ = disturbance;
  medium_.set_disturbance(disturbance);
}

void BusSimulation::power_off(NodeId node) {
  const std::size_t n = index_of(node);
  powered_[n] = false;
  next_[n] = kNever;
}

void BusSimulation::power_on(NodeId node, TrueTime at) {
  const std::size_t n = index_of(node);
  nodes_[n].power_on = at;
  powered_[n] = false;
  next_[n] = at;
}

void BusSimulation::refresh(std::size_t node) {
  if (!powered_[node]) return;
  const Microticks next = controllers_[node]->next_event();
  const bool never = next.value == std::numeric_limits<std::int64_t>::max();
  next_[node] = never ? kNever : std::max(now_, nodes_[node].oscillator.time_of(next));
}

void BusSimulation::run_until(TrueTime end) {
  while (true) {
    const auto earliest = static_cast<std::size_t>(std::min_element(next_.begin(), next_.end()) - next_.begin());
    const bool node_is_due = queue_.empty() || EventOrder{next_[earliest], Phase::kNode,
                                                          static_cast<std::uint8_t>(earliest), 0, 0} < queue_.next();
    const TrueTime time = node_is_due ? next_[earliest] : queue_.next().time;
    if (disturbance_ != nullptr && disturbance_->next() < time) {
      if (disturbance_->next() > end) break;
      now_ = std::max(now_, disturbance_->next());
      disturbance_->act(now_);
      continue;
    }
    if (time > end || time == kNever) break;
    TTF_CHECK(time >= now_, "time goes back from {} to {} ns", now_.ns, time.ns);
    now_ = time;
    if (node_is_due)
      step_node(earliest);
    else
      deliver(queue_.pop());
  }
  now_ = std::max(now_, end);
}

void BusSimulation::step_node(std::size_t node) {
  const Microticks ticks = nodes_[node].oscillator.ticks_at(now_);
  if (!powered_[node]) {
    powered_[node] = true;
    controllers_[node] = std::make_unique<bus::FlexRayController>(cluster_, static_cast<NodeId>(node), *ports_[node],
                                                                  *events_[node]);
    controllers_[node]->start_cold(ticks);
  }
  controllers_[node]->advance(ticks);
  refresh(node);
}

void BusSimulation::deliver(const MediumEvent& event) {
  const auto arrival = medium_.arrive(event, now_);
  if (!arrival) return;
  if (powered_[event.node]) {
    const timebase::Oscillator& oscillator = nodes_[event.node].oscillator;
    bus::Reception reception{arrival->channel, arrival->signal, oscillator.ticks_at(arrival->start),
                             oscillator.ticks_at(arrival->end), {}};
    if (arrival->signal == bus::Signal::kFrame) reception.frame = medium_.frame(*arrival);
    controllers_[event.node]->receive(reception);
    refresh(event.node);
  }
  medium_.release(*arrival);
}

Duration BusSimulation::precision(NodeId first) const {
  const std::int64_t round = cluster_.cycle().ns * (cluster_.flexray.gCycleCountMax + 1);
  std::optional<std::int64_t> reference;
  std::int64_t low = 0, high = 0;
  for (std::size_t n = index_of(first); n < nodes_.size(); ++n) {
    if (!powered_[n] || !controllers_[n]->synchronised()) continue;
    const std::int64_t time = controllers_[n]->clock()->global_time(nodes_[n].oscillator.ticks_at(now_)).ns;
    if (!reference) reference = time;
    std::int64_t difference = (time - *reference) % round;
    if (difference > round / 2) difference -= round;
    if (difference < -round / 2) difference += round;
    low = std::min(low, difference);
    high = std::max(high, difference);
  }
  return {high - low};
}

}  // namespace ttf::sim
