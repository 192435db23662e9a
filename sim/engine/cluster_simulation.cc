#include "sim/engine/cluster_simulation.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/check.h"
#include "nodes/host/node_clock.h"

namespace ttf::sim::engine {
namespace {

// The most frames and events beside FlexRay's. No node looks further ahead than to two observations of its clock, and no
// sensor than to a trigger and a strobe.
std::size_t most_pending(const schedules::model::Cluster& cluster) {
  std::size_t pending = 2 * (cluster.nodes.size() + cluster.sensors.size());
  for (std::size_t b = 0; b < cluster.can_buses.size(); ++b)
    pending += medium::CanMedium::most_pending(cluster, b, schedules::model::nodes_on_can(cluster, b));
  return pending;
}

recording::records::GuardedSignal signal_of(bus::ports::Signal signal) {
  using recording::records::GuardedSignal;
  switch (signal) {
    case bus::ports::Signal::kFrame: return GuardedSignal::kFrame;
    case bus::ports::Signal::kCas: return GuardedSignal::kCas;
    case bus::ports::Signal::kWakeup: return GuardedSignal::kWakeup;
    case bus::ports::Signal::kUndecodable: return GuardedSignal::kUndecodable;
  }
  TTF_CHECK(false, "signal {}", static_cast<int>(signal));
}

recording::records::GuardianIntervention record_of(const medium::StarCoupler::Intervention& one) {
  const bool cut = one.reason == bus::guardian::GuardianReason::kForwarded;
  return {one.at,
          one.branch,
          static_cast<std::uint8_t>(one.channel),
          signal_of(one.signal),
          one.reason,
          cut,
          one.until,
          cut ? "it lasts longer than its kind may" : to_text(one.reason)};
}

void add(nodes::host::ExecutiveCounts& sum, const nodes::host::ExecutiveCounts& one) {
  sum.overruns += one.overruns;
  sum.deadlines_missed += one.deadlines_missed;
  sum.torn_lists += one.torn_lists;
  sum.overwritten_lists += one.overwritten_lists;
  sum.discarded_lists += one.discarded_lists;
  sum.slot_problems += one.slot_problems;
  sum.saturated_signals += one.saturated_signals;
  sum.refused_fragments += one.refused_fragments;
  sum.refused_can_frames += one.refused_can_frames;
  sum.unlisted_fates += one.unlisted_fates;
}

}  // namespace

struct ClusterSimulation::FlexRayTap final : EnginePort {
  ClusterSimulation& simulation;
  FlexRayTap(ClusterSimulation& s, NodeId n) : EnginePort(s, n), simulation(s) {}
  void transmit(const bus::ports::Transmission& transmission) override {
    if (simulation.others_ != nullptr) simulation.others_->does(transmission);
    happens(transmission);
  }
  void transmit_on_both(const bus::ports::Transmission& transmission) override {
    if (simulation.others_ != nullptr) {
      transmit(transmission);
      return transmit(bus::ports::on_b(transmission));
    }
    simulation.frames_sent_ += 2;
    EnginePort::transmit_on_both(transmission);
  }
  void happens(const bus::ports::Transmission& transmission) {
    simulation.frames_sent_ += transmission.signal == bus::ports::Signal::kFrame ? 1 : 0;
    EnginePort::transmit(transmission);
  }
};

struct ClusterSimulation::CanTap final : bus::ports::CanPort {
  ClusterSimulation& simulation;
  NodeId node;
  std::size_t bus;
  CanTap(ClusterSimulation& s, NodeId n, std::size_t b) : simulation(s), node(n), bus(b) {}
  void send(const bus::ports::CanFrame& frame) override {
    if (simulation.others_ != nullptr) simulation.others_->does(processes::CanAct{bus, frame});
    simulation.send_can(bus, node, frame);
  }
};

// The medium reports the start of a frame; its sender reports the departure. Both instants are read from the
// sender's clocks when they come: a clock's reading after its next correction is not known before.
struct ClusterSimulation::CanLog final : recording::records::Sink {
  struct InFlight {
    recording::records::CanFrameSent frame;
    std::array<std::byte, 64> bytes{};
  };
  ClusterSimulation& simulation;
  std::vector<std::vector<InFlight>> in_flight;  // by bus and node
  CanLog(ClusterSimulation& s, std::size_t buses, std::size_t nodes)
      : simulation(s), in_flight(buses, std::vector<InFlight>(nodes)) {}

  using recording::records::Sink::on;
  void on(const recording::records::CanFrameSent& began) override {
    const NodeId sender = began.start.node;
    if (!simulation.is_here(index_of(sender))) return;
    const nodes::host::Executive& executive = *simulation.nodes_[index_of(sender)];
    InFlight& entry = in_flight[began.bus][index_of(sender)];
    entry.frame = began;
    std::copy(began.data.begin(), began.data.end(), entry.bytes.begin());
    entry.frame.data = std::span<const std::byte>(entry.bytes).first(began.data.size());
    entry.frame.start = executive.stamp(executive.oscillator().ticks_at(began.start.true_time));
    entry.frame.start.true_time = began.start.true_time;
  }
  void on(const recording::records::CanErrorFrame& error) override { stamped(error); }
  void on(const recording::records::CanStateChanged& change) override { stamped(change); }

 private:
  // A node that has just lost its supply says nothing.
  template <class Record> void stamped(Record record) const {
    const std::size_t node = index_of(record.stamp.node);
    if (!simulation.is_here(node) || !simulation.nodes_[node]) return;
    const TrueTime at = record.stamp.true_time;
    record.stamp = simulation.nodes_[node]->stamp(simulation.ticks(node));
    record.stamp.true_time = at;
    simulation.sink_.on(record);
  }
};

ClusterSimulation::ClusterSimulation(const SimulationConfig& config, recording::records::Sink& sink)
    : EngineOf(*config.cluster, most_pending(*config.cluster)), config_(config), others_(config.others), sink_(sink),
      can_ports_(cluster_.nodes.size(), std::vector<bus::ports::CanPort*>(cluster_.can_buses.size())),
      can_log_(std::make_unique<CanLog>(*this, cluster_.can_buses.size(), cluster_.nodes.size())),
      watches_(cluster_.nodes.size()), no_spread_(cluster_) {
  if (sink.wants_frames())
    medium_.set_log(&channel_log_.emplace(cluster_.flexray, medium::FlexRayMedium::kMostLogged, sink));
  else
    medium_.set_transparent(true);
  for (std::size_t b = 0; b < cluster_.can_buses.size(); ++b) {
    cans_.push_back(std::make_unique<medium::CanMedium>(cluster_, b, schedules::model::nodes_on_can(cluster_, b),
                                                        queue_, pool_, *can_log_, config_.seed, config_.replication));
    cans_.back()->set_bit_by_bit(config_.cans_bit_by_bit);
  }
  for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
    const schedules::model::Node& node = cluster_.nodes[n];
    const auto id = static_cast<NodeId>(n);
    flexray_taps_.push_back(node.flexray ? std::make_unique<FlexRayTap>(*this, id) : nullptr);
    for (std::size_t b = 0; b < cluster_.can_buses.size(); ++b)
      if (is_on_can(node, b)) {
        can_taps_.push_back(std::make_unique<CanTap>(*this, id, b));
        can_ports_[n][b] = can_taps_.back().get();
      }
    const std::optional<TrueTime> power_on = config_.power_on ? config_.power_on(id) : std::nullopt;
    const timebase::Oscillator crystal = nodes::host::drawn_oscillator(node, n, config.seed, config.replication);
    seat(crystal, power_on);
    first_cycle_.push_back(crystal.ticks_at(kFirstCycle));
    if (power_on) {
      for (auto& can : cans_) can->power_off(id, TrueTime{});
      continue;
    }
    if (others_ != nullptr) others_->outlook(n).begins(crystal.ticks_at(TrueTime{}));
    if (is_here(n))
      make_node(n,
                node.flexray ? std::optional(nodes::host::integrated_clock(crystal, cluster_, node, kFirstCycle))
                             : std::nullopt,
                first_cycle_[n], {});
    refresh(n);
  }
  make_guardians();
}

void ClusterSimulation::make_guardians() {
  // Their clocks are drawn after the nodes'.
  const auto crystal = [this](schedules::model::Channel channel) {
    schedules::model::Node guardian;
    guardian.microtick_ps = medium::StarCoupler::microtick_ps(cluster_, channel);
    return nodes::host::drawn_oscillator(guardian, cluster_.nodes.size() + index_of(channel), config_.seed,
                                         config_.replication);
  };
  bool integrated = false;
  for (std::size_t n = 0; n < nodes_.size(); ++n) integrated |= cluster_.nodes[n].flexray && is_powered(n);
  seat_guardians(crystal, integrated ? std::optional<FirstCycle>({kFirstCycle, cluster_.cycle()}) : std::nullopt);
  for (const schedules::model::Channel channel : {schedules::model::Channel::kA, schedules::model::Channel::kB})
    if (medium::StarCoupler* guardian = coupler(channel))
      guardian->on_intervention([this](const medium::StarCoupler::Intervention& one) { sink_.on(record_of(one)); });
}

ClusterSimulation::~ClusterSimulation() = default;

void ClusterSimulation::make_node(std::size_t node, std::optional<bus::controller::InitialClock> clock,
                                  Microticks power_on, const nodes::host::NodeStart& cold) {
  const auto id = static_cast<NodeId>(node);
  const schedules::model::Cluster* view = config_.view ? config_.view(id) : nullptr;
  const nodes::host::ExecutiveConfig executive{view != nullptr ? view : &cluster_,
                                               id,
                                               oscillator(id),
                                               clock,
                                               config_.seed,
                                               config_.replication,
                                               power_on,
                                               cold.how,
                                               cold.after,
                                               nullptr,
                                               first_cycle_[node]};
  nodes_[node] =
      std::make_unique<nodes::host::Executive>(executive, config_.make_steps(id), flexray_taps_[node].get(),
                                               can_ports_[node], static_cast<nodes::host::SensorLines&>(*this), sink_);
  watches_[node] = {nodes_[node]->controller(), &oscillator(id)};
}

void ClusterSimulation::start(std::size_t node, Microticks now) {
  if (others_ != nullptr) others_->outlook(node).begins(now);
  if (is_here(node)) start_here(node, now);
  for (auto& can : cans_) can->power_on(static_cast<NodeId>(node), this->now());
}

void ClusterSimulation::start_here(std::size_t node, Microticks now) {
  const auto id = static_cast<NodeId>(node);
  // At a later power-on the other nodes are awake.
  const bool first = powered_since(node) < TrueTime{};
  const nodes::host::NodeStart cold = first && config_.cold ? config_.cold(id) : nodes::host::NodeStart{};
  if (cold.how != nodes::host::ColdStart::kSleeps) {
    const LocalTime local = oscillator(id).local_time(now);
    sink_.on(recording::records::PowerChanged{{oscillator(id).time_of(now), local, GlobalTime{local.ns}, id}, true});
  }
  make_node(node, std::nullopt, now, cold);
}

void ClusterSimulation::stop(std::size_t node) {
  if (others_ != nullptr) others_->outlook(node).ends();
  for (auto& can : cans_) can->power_off(static_cast<NodeId>(node), now());
  if (!is_here(node)) return;
  // A sleeping node's supply was not recorded.
  if (!nodes_[node]->asleep()) sink_.on(recording::records::PowerChanged{nodes_[node]->stamp(ticks(node)), false});
  add(gone_, nodes_[node]->counts());
  nodes_[node].reset();
  watches_[node] = {};
}

Microticks ClusterSimulation::next_event(std::size_t node) const {
  if (others_ == nullptr) return EngineOf::next_event(node);
  const Microticks turn = others_->outlook(node).turn();
  return is_here(node) ? std::min(turn, nodes_[node]->next_event()) : turn;
}

void ClusterSimulation::advance(std::size_t node, Microticks now) {
  if (others_ != nullptr) return take_turn(node, now);
  EngineOf::advance(node, now);
  if (!config_.compares_clocks) return;
  const timebase::CycleClock* clock = watches_[node].clock();
  if (clock != nullptr && clock->cycle() != watches_[node].cycle) watch_cycle(node, *clock);
}

void ClusterSimulation::transmit(std::size_t node, const bus::ports::Transmission& transmission) {
  if (flexray_taps_[node]) flexray_taps_[node]->happens(transmission);
}

void ClusterSimulation::receive(std::size_t node, const bus::ports::Reception& reception) {
  if (is_here(node)) EngineOf::receive(node, reception);
  if (others_ != nullptr) others_->outlook(node).receives_flexray(ticks(node));
}

bool ClusterSimulation::receive_on_both(std::size_t node, const bus::ports::Reception& reception) {
  if (others_ == nullptr) return EngineOf::receive_on_both(node, reception);
  receive(node, reception);
  receive(node, bus::ports::on_b(reception));
  return true;
}

void ClusterSimulation::drifts(std::size_t node) {
  if (is_here(node)) nodes_[node]->drift(oscillator(static_cast<NodeId>(node)));
}

void ClusterSimulation::disturbs_cans(medium::CanDisturbance* disturbance) {
  for (auto& can : cans_) can->set_disturbance(disturbance);
}

const nodes::host::Executive& ClusterSimulation::node(NodeId id) const {
  TTF_CHECK(powered(id) && is_here(index_of(id)), "{} is without supply or elsewhere", cluster_.node(id).name);
  return *nodes_[index_of(id)];
}

void ClusterSimulation::happen(const medium::MediumEvent& event) {
  // These three are not at a node.
  if (event.kind == medium::MediumEvent::Kind::kCanArbitration) return cans_[event.channel_or_bus]->arbitrate(now());
  if (event.kind == medium::MediumEvent::Kind::kCanBits) return cans_[event.channel_or_bus]->end_bits(now());
  if (event.kind == medium::MediumEvent::Kind::kObservation) return observe();
  const std::size_t node = event.node;
  const bool arrives = is_powered(node);
  switch (event.kind) {
    case medium::MediumEvent::Kind::kCanArrival:
      if (arrives && is_here(node))
        nodes_[node]->receive_can(event.channel_or_bus,
                                  {event.identifier, event.flexible_data_rate, pool_.bytes(event.frame)}, ticks(node));
      if (arrives && others_ != nullptr) others_->outlook(node).receives_can(ticks(node));
      pool_.release(event.frame);
      break;
    case medium::MediumEvent::Kind::kStrobe:
      if (arrives && is_here(node))
        nodes_[node]->strobe(static_cast<SensorId>(event.sensor), event.identifier, ticks(node));
      break;
    case medium::MediumEvent::Kind::kTrigger:
      if (arrives && is_here(node)) nodes_[node]->trigger(static_cast<SensorId>(event.sensor), ticks(node));
      if (arrives && others_ != nullptr) others_->outlook(node).receives_trigger(ticks(node));
      break;
    case medium::MediumEvent::Kind::kCanSent:
      if (arrives && is_here(node)) {
        recording::records::CanFrameSent& sent = can_log_->in_flight[event.channel_or_bus][node].frame;
        sent.end.true_time = now();
        nodes_[node]->can_frame_sent(sent, ticks(node));
      }
      return;
    case medium::MediumEvent::Kind::kFlexRayArrival:
    case medium::MediumEvent::Kind::kCanArbitration:
    case medium::MediumEvent::Kind::kCanBits:
    case medium::MediumEvent::Kind::kObservation: return;
  }
  refresh(node);
}

// Schedules observations of all clocks at the corners of this node's clock: its cycle start and its correction start.
void ClusterSimulation::watch_cycle(std::size_t node, const timebase::CycleClock& clock) {
  Watch& watch = watches_[node];
  watch.cycle = clock.cycle();
  const Microticks correction = clock.start_of(Macroticks{cluster_.flexray.gOffsetCorrectionStart});
  schedule_observation(node, now());
  schedule_observation(node, std::max(now(), watch.crystal->time_of(correction)));
}

void ClusterSimulation::schedule_observation(std::size_t node, TrueTime at) {
  medium::MediumEvent event;
  event.kind = medium::MediumEvent::Kind::kObservation;
  queue_.schedule(at, medium::Phase::kObserver, static_cast<std::uint8_t>(node), event);
}

void ClusterSimulation::observe() {
  ClockSpread spread = no_spread_;
  constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::min();
  std::int64_t newest = kNone, oldest = std::numeric_limits<std::int64_t>::max();
  for (const Watch& watch : watches_) {
    const timebase::CycleClock* clock = watch.clock();
    if (clock == nullptr) continue;
    const Microticks at = watch.crystal->ticks_at(now());
    if (at < clock->cycle_start()) return;  // before this node's first cycle
    spread.add(clock->global_time(at));
    newest = std::max(newest, clock->cycle());
    oldest = std::min(oldest, clock->cycle());
  }
  if (newest == kNone) return;
  // The oldest of the nodes' present cycles, as counted by the nodes that have run the longest.
  const int round = cluster_.flexray.gCycleCountMax + 1;
  std::int64_t cycle = newest - oldest <= round / 2 ? oldest : newest;
  if (cycle != oldest)
    for (const Watch& watch : watches_)
      if (const timebase::CycleClock* clock = watch.clock()) {
        const std::int64_t behind = (newest - clock->cycle()) % round;
        if (behind <= round / 2) cycle = std::min(cycle, newest - behind);
      }
  precision_of_pair_ = std::max(precision_of_pair_, spread.width());
  precision_ = std::max(precision_, precision_of_pair_);
  // After the cluster has started anew, its cycles count from 0 again.
  if (cycle / 2 == reported_pair_) return;
  sink_.on(recording::records::PrecisionSample{now(), cycle, precision_of_pair_});
  reported_pair_ = cycle / 2;
  precision_of_pair_ = {};
}

nodes::host::ExecutiveCounts ClusterSimulation::counts() const {
  nodes::host::ExecutiveCounts sum = gone_;
  for (const auto& node : nodes_)
    if (node) add(sum, node->counts());
  return sum;
}

}  // namespace ttf::sim::engine
