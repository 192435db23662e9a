#include "sim/cluster_simulation.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/check.h"
#include "core/random.h"

namespace ttf::sim {
namespace {

constexpr TrueTime kNever{std::numeric_limits<std::int64_t>::max()};
constexpr std::size_t kPendingEvents = 4096;

timebase::Oscillator make_oscillator(const schedules::Node& node, std::size_t index, const SimulationConfig& config) {
  const auto entity = static_cast<std::uint16_t>(index);
  RandomStream drift({config.seed, config.replication, Purpose::kClockDrift, entity, 0});
  RandomStream phase({config.seed, config.replication, Purpose::kClockPhase, entity, 0});
  const std::int64_t ppb = node.drift_ppb ? *node.drift_ppb : drift.integer(-node.max_drift_ppb, node.max_drift_ppb);
  return {node.microtick_ps, ppb, phase.integer(0, node.microtick_ps - 1)};
}

// Integrated nodes agree on rate and offset to within their microticks: the rate correction makes the cycle last its
// nominal time, and cycle 0 starts at the first microtick after kFirstCycle.
bus::InitialClock integrated(const timebase::Oscillator& oscillator, const schedules::Cluster& cluster,
                             const schedules::Node& node) {
  bus::InitialClock clock;
  clock.cycle_start = oscillator.ticks_at(kFirstCycle) + Microticks{1};
  // Ticks in a thousand cycles, so that rounding to one microtick per cycle is all that is lost.
  const std::int64_t thousand = (oscillator.ticks_at(kFirstCycle + cluster.cycle() * 1000) -
                                 oscillator.ticks_at(kFirstCycle)).value;
  if (cluster.synchronisation)
    clock.rate = static_cast<int>((thousand + 500) / 1000 - node.flexray->pMicroPerCycle);
  return clock;
}

}  // namespace

struct ClusterSimulation::FlexRayTap final : bus::FlexRayPort {
  ClusterSimulation& simulation;
  NodeId node;
  FlexRayTap(ClusterSimulation& s, NodeId n) : simulation(s), node(n) {}
  void transmit(const bus::Transmission& transmission) override {
    simulation.frames_sent_ += transmission.signal == bus::Signal::kFrame ? 1 : 0;
    const timebase::Oscillator& oscillator = simulation.nodes_[index_of(node)]->oscillator();
    simulation.flexray_.transmit(node, transmission, oscillator.time_of(transmission.start),
                                 oscillator.time_of(transmission.end));
  }
  bool carrier(schedules::Channel channel) const override {
    return simulation.flexray_.carrier(node, channel, simulation.now_);
  }
};

struct ClusterSimulation::CanTap final : bus::CanPort {
  ClusterSimulation& simulation;
  NodeId node;
  std::size_t bus;
  CanTap(ClusterSimulation& s, NodeId n, std::size_t b) : simulation(s), node(n), bus(b) {}
  void send(const bus::CanFrame& frame) override { simulation.cans_[bus]->send(node, simulation.now_, frame); }
};

// The medium says that a frame began; its sender reports it when it has left. Both instants are looked up on the sender's
// clocks when they come: nobody knows beforehand what a clock will show after its next correction.
struct ClusterSimulation::CanLog final : records::Sink {
  struct InFlight {
    records::CanFrameSent frame;
    std::array<std::byte, 64> bytes{};
  };
  ClusterSimulation& simulation;
  std::vector<InFlight> in_flight;   // by bus
  CanLog(ClusterSimulation& s, std::size_t buses) : simulation(s), in_flight(buses) {}

  using records::Sink::on;
  void on(const records::CanFrameSent& began) override {
    const NodeId sender = began.start.node;
    const nodes::Executive& executive = *simulation.nodes_[index_of(sender)];
    InFlight& entry = in_flight[began.bus];
    entry.frame = began;
    std::copy(began.data.begin(), began.data.end(), entry.bytes.begin());
    entry.frame.data = std::span<const std::byte>(entry.bytes).first(began.data.size());
    entry.frame.start = executive.stamp(executive.oscillator().ticks_at(began.start.true_time));
    entry.frame.start.true_time = began.start.true_time;
    MediumEvent event;
    event.kind = MediumEvent::Kind::kCanSent;
    event.node = static_cast<std::uint8_t>(sender);
    event.channel_or_bus = began.bus;
    simulation.queue_.schedule(began.end.true_time, Phase::kArrival, event.node, event);
  }
};

ClusterSimulation::ClusterSimulation(const SimulationConfig& config, records::Sink& sink)
    : cluster_(*config.cluster),
      sink_(sink),
      queue_(kPendingEvents),
      pool_(kPendingEvents),
      flexray_(cluster_, queue_, pool_),
      can_log_(std::make_unique<CanLog>(*this, cluster_.can_buses.size())),
      watched_cycle_(cluster_.nodes.size(), -1) {
  std::vector<std::vector<bool>> on_can(cluster_.can_buses.size(), std::vector<bool>(cluster_.nodes.size()));
  for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
    for (const schedules::Task& task : cluster_.nodes[n].tasks)
      for (const auto* bindings : {&task.reads, &task.writes})
        for (const schedules::PortBinding& binding : *bindings)
          if (binding.can_bus) on_can[*binding.can_bus][n] = true;
  for (std::size_t b = 0; b < cluster_.can_buses.size(); ++b) {
    std::vector<NodeId> members;
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      if (on_can[b][n]) members.push_back(static_cast<NodeId>(n));
    cans_.push_back(std::make_unique<CanMedium>(cluster_, b, members, queue_, pool_, *can_log_));
  }
  for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
    const schedules::Node& node = cluster_.nodes[n];
    const auto id = static_cast<NodeId>(n);
    const timebase::Oscillator oscillator = make_oscillator(node, n, config);
    nodes::ExecutiveConfig executive{config.cluster, id, oscillator, std::nullopt, config.seed, config.replication,
                                     oscillator.ticks_at(kFirstCycle)};
    bus::FlexRayPort* port = nullptr;
    if (node.flexray) {
      executive.clock = integrated(oscillator, cluster_, node);
      flexray_taps_.push_back(std::make_unique<FlexRayTap>(*this, id));
      port = flexray_taps_.back().get();
    }
    std::vector<bus::CanPort*> ports(cluster_.can_buses.size(), nullptr);
    for (std::size_t b = 0; b < ports.size(); ++b)
      if (on_can[b][n]) {
        can_taps_.push_back(std::make_unique<CanTap>(*this, id, b));
        ports[b] = can_taps_.back().get();
      }
    nodes_.push_back(std::make_unique<nodes::Executive>(executive, config.make_steps(id), port, ports,
                                                        static_cast<nodes::SensorLines&>(*this), sink_));
    next_.push_back(kNever);
    refresh(n);
  }
}

ClusterSimulation::~ClusterSimulation() = default;

void ClusterSimulation::refresh(std::size_t node) {
  const Microticks next = nodes_[node]->next_event();
  const bool never = next.value == std::numeric_limits<std::int64_t>::max();
  next_[node] = never ? kNever : std::max(now_, nodes_[node]->oscillator().time_of(next));
}

void ClusterSimulation::run_until(TrueTime end) {
  while (true) {
    const auto earliest = static_cast<std::size_t>(std::min_element(next_.begin(), next_.end()) - next_.begin());
    const bool node_is_due = queue_.empty() || EventOrder{next_[earliest], Phase::kNode,
                                                          static_cast<std::uint8_t>(earliest), 0, 0} < queue_.next();
    const TrueTime time = node_is_due ? next_[earliest] : queue_.next().time;
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

void ClusterSimulation::step_node(std::size_t node) {
  nodes::Executive& executive = *nodes_[node];
  executive.advance(executive.oscillator().ticks_at(now_));
  watch_cycle(node);
  refresh(node);
}

void ClusterSimulation::deliver(const MediumEvent& event) {
  // These two are not at a node.
  if (event.kind == MediumEvent::Kind::kCanArbitration) return cans_[event.channel_or_bus]->arbitrate(now_);
  if (event.kind == MediumEvent::Kind::kObservation) return observe();
  nodes::Executive& executive = *nodes_[event.node];
  const timebase::Oscillator& oscillator = executive.oscillator();
  switch (event.kind) {
    case MediumEvent::Kind::kFlexRayArrival:
      if (const auto arrival = flexray_.arrive(event, now_)) {
        bus::Reception reception{arrival->channel, arrival->signal, oscillator.ticks_at(arrival->start),
                                 oscillator.ticks_at(arrival->end), {}};
        if (arrival->signal == bus::Signal::kFrame) reception.frame = flexray_.frame(*arrival);
        executive.receive(reception);
        flexray_.release(*arrival);
      }
      break;
    case MediumEvent::Kind::kCanArrival:
      executive.receive_can(event.channel_or_bus,
                            {event.identifier, event.flexible_data_rate, pool_.bytes(event.frame)},
                            oscillator.ticks_at(now_));
      pool_.release(event.frame);
      break;
    case MediumEvent::Kind::kStrobe:
      executive.strobe(static_cast<SensorId>(event.sensor), event.identifier, oscillator.ticks_at(now_));
      break;
    case MediumEvent::Kind::kTrigger:
      executive.trigger(static_cast<SensorId>(event.sensor), oscillator.ticks_at(now_));
      break;
    case MediumEvent::Kind::kCanSent:
      executive.can_frame_sent(can_log_->in_flight[event.channel_or_bus].frame, oscillator.ticks_at(now_));
      return;
    case MediumEvent::Kind::kCanArbitration:
    case MediumEvent::Kind::kObservation: return;
  }
  refresh(event.node);
}

void ClusterSimulation::trigger(SensorId sensor) {
  MediumEvent event;
  event.kind = MediumEvent::Kind::kTrigger;
  event.node = static_cast<std::uint8_t>(cluster_.sensor(sensor).device);
  event.sensor = static_cast<std::uint8_t>(sensor);
  queue_.schedule(now_, Phase::kArrival, event.node, event);
}

void ClusterSimulation::strobe(SensorId sensor, std::uint32_t sequence) {
  MediumEvent event;
  event.kind = MediumEvent::Kind::kStrobe;
  event.node = static_cast<std::uint8_t>(cluster_.sensor(sensor).host);
  event.sensor = static_cast<std::uint8_t>(sensor);
  event.identifier = sequence;
  queue_.schedule(now_, Phase::kArrival, event.node, event);
}

// Looks at all clocks at the corners of this node's: where its cycle starts, and where its correction starts.
void ClusterSimulation::watch_cycle(std::size_t node) {
  const timebase::CycleClock* clock = nodes_[node]->clock();
  if (clock == nullptr || clock->cycle() == watched_cycle_[node]) return;
  watched_cycle_[node] = clock->cycle();
  const Microticks correction = clock->start_of(Macroticks{cluster_.flexray.gOffsetCorrectionStart});
  MediumEvent event;
  event.kind = MediumEvent::Kind::kObservation;
  queue_.schedule(now_, Phase::kObserver, static_cast<std::uint8_t>(node), event);
  queue_.schedule(std::max(now_, nodes_[node]->oscillator().time_of(correction)), Phase::kObserver,
                  static_cast<std::uint8_t>(node), event);
}

void ClusterSimulation::observe() {
  GlobalTime earliest{std::numeric_limits<std::int64_t>::max()}, latest{std::numeric_limits<std::int64_t>::min()};
  std::int64_t cycle = std::numeric_limits<std::int64_t>::max();
  for (const auto& node : nodes_) {
    const timebase::CycleClock* clock = node->clock();
    if (clock == nullptr) continue;
    const Microticks ticks = node->oscillator().ticks_at(now_);
    if (ticks < clock->cycle_start()) return;   // before this node's first cycle
    const GlobalTime global = clock->global_time(ticks);
    earliest = std::min(earliest, global);
    latest = std::max(latest, global);
    cycle = std::min(cycle, clock->cycle());
  }
  precision_of_pair_ = std::max(precision_of_pair_, latest - earliest);
  precision_ = std::max(precision_, precision_of_pair_);
  if (cycle / 2 > reported_pair_) {
    sink_.on(records::PrecisionSample{now_, cycle, precision_of_pair_});
    reported_pair_ = cycle / 2;
    precision_of_pair_ = {};
  }
}

nodes::ExecutiveCounts ClusterSimulation::counts() const {
  nodes::ExecutiveCounts sum;
  for (const auto& node : nodes_) {
    const nodes::ExecutiveCounts& one = node->counts();
    sum.overruns += one.overruns;
    sum.deadlines_missed += one.deadlines_missed;
    sum.torn_lists += one.torn_lists;
    sum.overwritten_lists += one.overwritten_lists;
    sum.discarded_lists += one.discarded_lists;
    sum.slot_problems += one.slot_problems;
    sum.saturated_signals += one.saturated_signals;
    sum.refused_fragments += one.refused_fragments;
  }
  return sum;
}

}  // namespace ttf::sim
