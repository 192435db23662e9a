#include "experiments/campaign/trial.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "bus/wire/pdu_codec.h"
#include "core/check.h"
#include "core/random.h"
#include "faults/believed_schedule.h"
#include "schedules/model/wire_times.h"
#include "sim/crank/bus_simulation.h"
#include "sim/crank/clock_spread.h"
#include "sim/faults/injector.h"

namespace ttf::experiments::campaign {
namespace {

using bus::poc::PocKind;
using schedules::model::Channel;

constexpr Duration kBeforeFirstCycle = Duration::milliseconds(1);  // in a running cluster
constexpr int kSamplesPerCycle = 4;                                // of the precision
constexpr int kCyclesToPowerOn = 2;                                // all nodes, in a start-up
constexpr int kCyclesToSettle = 2;                                 // after the last node became active
constexpr std::int64_t kGuardianDriftPpb = 1'500'000;

// The lists and the network management vector of one node, written anew in every cycle.
class Host {
 public:
  Host(const schedules::model::Cluster& cluster, NodeId node) : cluster_(cluster), node_(node) {
    for (const schedules::model::FrameSlot& frame : cluster.frames)
      if (frame.sender == node && frame.pdu != kNoPdu &&
          std::find(pdus_.begin(), pdus_.end(), frame.pdu) == pdus_.end())
        pdus_.push_back(frame.pdu);
    vector_.resize(static_cast<std::size_t>(cluster.flexray.gNetworkManagementVectorLength));
  }
  void write(bus::controller::FlexRayController& controller, std::int64_t cycle) {
    for (const PduId pdu : pdus_) {
      const schedules::model::PduLayout& layout = cluster_.pdu(pdu);
      const auto bytes = static_cast<std::size_t>(layout.fragment_bytes);
      const int fragments = layout.max_fragments();
      list_.assign(bytes * static_cast<std::size_t>(fragments), std::byte{0});
      for (int fragment = 0; fragment < fragments; ++fragment) {
        const auto payload = std::span<std::byte>(list_).subspan(bytes * static_cast<std::size_t>(fragment), bytes);
        write_header(layout, payload, "sequence", static_cast<std::uint32_t>(cycle));
        write_header(layout, payload, "fragment", static_cast<std::uint32_t>(fragment));
        write_header(layout, payload, "count", static_cast<std::uint32_t>(layout.max_elements));
      }
      controller.outgoing(pdu).write({static_cast<std::uint32_t>(cycle), fragments, list_});
    }
    if (vector_.empty()) return;
    vector_.front() = static_cast<std::byte>(index_of(node_) + 1);
    vector_.back() = static_cast<std::byte>(cycle & 0xff);
    controller.set_network_management_vector(vector_);
  }

 private:
  static void write_header(const schedules::model::PduLayout& layout, std::span<std::byte> payload,
                           std::string_view name, std::uint32_t value) {
    const std::size_t signal = bus::wire::header_signal(layout, name);
    const int bits = layout.header[signal].bits;
    bus::wire::write_header_raw(layout, payload, signal, bits >= 32 ? value : value & ((1u << bits) - 1));
  }

  const schedules::model::Cluster& cluster_;
  NodeId node_;
  std::vector<PduId> pdus_;
  std::vector<std::byte> list_, vector_;
};

class Trial final : public sim::medium::Disturbance, public sim::crank::Plant, public recording::records::Sink {
 public:
  // `drawn` null: the same start-up without the fault.
  Trial(const CampaignFile& campaign, const schedules::model::Cluster& cluster, const DrawnFault* drawn, bool starts_up,
        std::uint32_t index, const evaluation::faults::JudgeSettings& settings, TrialStory* story, bool bit_true)
      : campaign_(campaign), cluster_(cluster), plan_{campaign.file, drawn != nullptr ? std::vector{drawn->fault}
                                                                                      : std::vector<faults::Fault>{}},
        believed_(plan_, cluster), index_(index), faulty_(settings.faulty), judge_(cluster, settings), story_(story),
        restart_at_(cluster.nodes.size(), kNever) {
    std::vector<sim::crank::BusNode> nodes;
    std::vector<bus::controller::ControllerEvents*> events;
    const TrueTime origin = starts_up ? TrueTime{} : TrueTime{} + kBeforeFirstCycle;
    for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
      const auto id = static_cast<NodeId>(n);
      sim::crank::BusNode node{
          oscillator(n, cluster.nodes[n].microtick_ps, cluster.nodes[n].drift_ppb, cluster.nodes[n].max_drift_ppb)};
      node.view = believed_.of(id);
      if (starts_up) {
        node.power_on = TrueTime{stream(Purpose::kCampaign, n + 1).integer(0, cluster.cycle().ns * kCyclesToPowerOn)};
      } else {
        node.clock = integrated(node.oscillator, origin, *cluster.nodes[n].flexray);
        judge_.begins_active(id);
      }
      nodes.push_back(node);
      witnesses_.push_back(std::make_unique<Witness>(*this, id));
      events.push_back(witnesses_.back().get());
    }
    std::vector<timebase::Oscillator> guardians;
    for (const Channel channel : {Channel::kA, Channel::kB})
      guardians.push_back(oscillator(cluster.nodes.size() + index_of(channel),
                                     sim::medium::StarCoupler::needed(cluster, channel)
                                         ? sim::medium::StarCoupler::microtick_ps(cluster, channel)
                                         : 25'000,
                                     std::nullopt, kGuardianDriftPpb));
    simulation_ = std::make_unique<sim::crank::BusSimulation>(cluster, std::move(nodes), std::move(events), guardians);
    injector_ = std::make_unique<sim::faults::Injector>(plan_, cluster, *this, campaign.seed, index, *this, origin);
    simulation_->set_disturbance(this);
    simulation_->medium().set_transparent(!bit_true);
    for (const Channel channel : {Channel::kA, Channel::kB})
      if (sim::medium::StarCoupler* coupler = simulation_->coupler(channel))
        coupler->on_intervention([this](const sim::medium::StarCoupler::Intervention& intervention) {
          judge_.guardian_intervened(intervention.at);
          if (story_ != nullptr) story_->guardian_intervened(intervention);
        });
  }

  void run(TrueTime end) {
    const Duration step{cluster_.cycle().ns / kSamplesPerCycle};
    for (TrueTime at = simulation_->now() + step; at <= end; at += step) {
      simulation_->run_until(at);
      sample();
    }
  }
  std::optional<TrueTime> run_until_all_active(TrueTime end) {
    const Duration step{cluster_.cycle().ns / kSamplesPerCycle};
    for (TrueTime at = simulation_->now() + step; at <= end; at += step) {
      simulation_->run_until(at);
      if (judge_.all_fault_free_active()) return at;
    }
    return std::nullopt;
  }
  const evaluation::faults::Judgement& finish() { return judge_.finish(simulation_->now()); }
  const sim::faults::Injector::Activation& activation() const { return injector_->activations().front(); }

 private:
  // What one controller tells its host.
  struct Witness final : bus::controller::ControllerEvents {
    Witness(Trial& of, NodeId id) : trial(of), node(id), host(of.cluster_, id) {}
    Trial& trial;
    NodeId node;
    Host host;
    TrueTime now() const { return trial.simulation_->now(); }
    void cycle_started(std::int64_t cycle, Microticks) override {
      host.write(trial.simulation_->controller(node), cycle);
    }
    void slot_problem(std::int64_t, int, Channel, bus::controller::SlotStatus status, Microticks) override {
      trial.judge_.slot_problem(node, status, now());
    }
    void frame_sent(const bus::ports::Transmission& transmission, std::int64_t, bool, PduId, std::uint32_t, int,
                    bool) override {
      trial.judge_.frame_sent(node, transmission.slot, transmission.channel, transmission.content, now());
    }
    bool wants_bytes() const override { return false; }
    void frame_received(std::int64_t, int slot, Channel channel, const bus::wire::DecodedFrame& frame,
                        Microticks) override {
      trial.judge_.frame_received(node, slot, channel, frame, now());
    }
    void clock_corrected(std::int64_t, const timebase::Correction& offset, const timebase::Correction& rate,
                         Microticks) override {
      trial.judge_.clock_corrected(node, offset.missing || rate.missing, offset.limit_reached || rate.limit_reached,
                                   now());
    }
    void state_changed(PocKind from, const bus::poc::PocStep& step, Microticks) override {
      trial.changed(node, from, step);
    }
  };

  void changed(NodeId node, PocKind from, const bus::poc::PocStep& step) {
    const TrueTime at = simulation_->now();
    judge_.state_changed(node, from, step.next.kind, at);
    if (story_ != nullptr) story_->state_changed(node, from, step, at);
    if (step.next.kind == PocKind::kHalt && campaign_.restart_halted_after > 0)
      restart_at_[index_of(node)] = at + cluster_.cycle() * campaign_.restart_halted_after;
  }

  void sample() {
    sim::crank::ClockSpread spread(cluster_);
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
      const auto id = static_cast<NodeId>(n);
      if (faulty_[n] || !simulation_->powered(id) || !simulation_->controller(id).synchronised()) continue;
      spread.add(
          simulation_->controller(id).clock()->global_time(simulation_->oscillator(id).ticks_at(simulation_->now())));
    }
    judge_.precision(spread.width(), simulation_->now());
  }

  RandomStream stream(Purpose purpose, std::size_t entity) const {
    return RandomStream({campaign_.seed, index_, purpose, static_cast<std::uint16_t>(entity), 0});
  }
  timebase::Oscillator oscillator(std::size_t entity, std::int64_t microtick_ps, std::optional<std::int64_t> fixed,
                                  std::int64_t most) const {
    RandomStream draw = stream(Purpose::kClockDrift, entity);
    const std::int64_t ppb = draw.integer(-most, most);
    return {microtick_ps, fixed.value_or(ppb), draw.integer(0, microtick_ps - 1)};
  }
  // As start-up leaves a node: its rate correction cancels its drift to a microtick per cycle.
  bus::controller::InitialClock integrated(const timebase::Oscillator& oscillator, TrueTime origin,
                                           const schedules::model::NodeParameters& p) const {
    const std::int64_t thousand =
        (oscillator.ticks_at(origin + cluster_.cycle() * 1000) - oscillator.ticks_at(origin)).value;
    return {oscillator.ticks_at(origin) + Microticks{1}, static_cast<int>((thousand + 500) / 1000 - p.pMicroPerCycle)};
  }

  // --- the disturbance: the fault, and hosts that restart halted controllers
  bool touches(NodeId sender, Channel channel) const override { return injector_->touches(sender, channel); }
  bool leaving(sim::medium::Leaving& signal) override { return injector_->leaving(signal); }
  bool arriving(sim::medium::Arriving& signal) override { return injector_->arriving(signal); }
  TrueTime next() const override {
    return std::min(injector_->next(), *std::min_element(restart_at_.begin(), restart_at_.end()));
  }
  void act(TrueTime at) override {
    if (injector_->next() <= at) injector_->act(at);
    for (std::size_t n = 0; n < restart_at_.size(); ++n) {
      if (restart_at_[n] > at) continue;
      restart_at_[n] = kNever;
      const auto id = static_cast<NodeId>(n);
      if (!simulation_->powered(id) || simulation_->controller(id).state().kind != PocKind::kHalt) continue;
      simulation_->power_off(id);
      simulation_->power_on(id, at);
    }
  }

  // --- the plant: who loses its supply is told to the judge
  TrueTime now() const override { return simulation_->now(); }
  bool powered(NodeId node) const override { return simulation_->powered(node); }
  void power_off(NodeId node) override {
    judge_.lost_supply(node, simulation_->now());
    simulation_->power_off(node);
  }
  void power_on(NodeId node, TrueTime at) override { simulation_->power_on(node, at); }
  void change_drift(NodeId node, std::int64_t ppb) override { simulation_->change_drift(node, ppb); }
  void emit(const sim::medium::Leaving& signal, std::optional<NodeId> source) override {
    simulation_->emit(signal, source);
  }

  using recording::records::Sink::on;
  void on(const recording::records::FaultActivity& activity) override {
    if (story_ != nullptr) story_->fault_acts(activity);
  }

  const CampaignFile& campaign_;
  const schedules::model::Cluster& cluster_;
  faults::FaultPlan plan_;
  faults::BelievedSchedules believed_;
  std::uint32_t index_;
  std::vector<bool> faulty_;
  evaluation::faults::FaultJudge judge_;
  TrialStory* story_;
  std::vector<TrueTime> restart_at_;  // by NodeId
  std::vector<std::unique_ptr<Witness>> witnesses_;
  std::unique_ptr<sim::crank::BusSimulation> simulation_;
  std::unique_ptr<sim::faults::Injector> injector_;
};

template <class Times> std::uint16_t bits_of(const Times& times) {
  unsigned bits = 0;
  for (std::size_t i = 0; i < times.size(); ++i) bits |= times[i].has_value() ? 1u << i : 0u;
  return static_cast<std::uint16_t>(bits);
}

FaultOutcome outcome_of(const evaluation::faults::Judgement& judgement,
                        const sim::faults::Injector::Activation& activation) {
  FaultOutcome outcome;
  outcome.activated = activation.times > 0;
  outcome.seen_by_others = bits_of(judgement.seen_by_others);
  outcome.seen_by_itself = bits_of(judgement.seen_by_itself);
  outcome.harms = static_cast<std::uint8_t>(bits_of(judgement.harms));
  outcome.still_out = static_cast<std::int16_t>(judgement.still_out);
  const auto after = [&](const evaluation::faults::Judgement::Since& since) {
    return since ? std::optional(std::max<std::int64_t>(0, (*since - activation.first).ns)) : std::nullopt;
  };
  outcome.detected_after = after(judgement.detected());
  outcome.passive_after = after(judgement.passive);
  outcome.halt_after = after(judgement.halt);
  if (judgement.reintegration) outcome.reintegrated_after = judgement.reintegration->ns;
  const evaluation::faults::Judgement::Harmed* first = nullptr;
  for (const auto& harm : judgement.harms)
    if (harm && (first == nullptr || harm->first < first->first)) first = &*harm;
  if (first != nullptr) {
    outcome.harmed = first->node;
    outcome.sender = first->sender;
    outcome.slot = first->slot;
    outcome.harmed_after = after(first->first);
  }
  return outcome;
}

}  // namespace

FaultOutcome run_trial(const CampaignFile& campaign, const schedules::model::Cluster& cluster, const DrawnFault& drawn,
                       std::uint32_t index, TrialStory* story, bool bit_true) {
  const bool starts_up = drawn.starts_up;
  const TrueTime end = TrueTime{} + cluster.cycle() * (starts_up ? campaign.startup_cycles : campaign.steady_cycles);
  evaluation::faults::JudgeSettings settings;
  settings.assumed_precision = assumed_precision(cluster.flexray);
  settings.starts_up = starts_up;
  bool starts_without = true;
  if (starts_up) {
    // The same start-up without the fault: when it is over, and which checks it shows until then.
    settings.faulty.assign(cluster.nodes.size(), false);
    Trial without(campaign, cluster, nullptr, true, index, settings, nullptr, bit_true);
    const auto settled = without.run_until_all_active(end);
    starts_without = settled.has_value();
    settings.settled = settled.value_or(end) + cluster.cycle() * kCyclesToSettle;
    const evaluation::faults::Judgement& usual = without.finish();
    for (std::size_t c = 0; c < evaluation::faults::kAllChecks.size(); ++c)
      settings.usual[c] = usual.seen_by_others[c].has_value();
  }
  const faults::Fault& fault = drawn.fault;
  const TrueTime origin = starts_up ? TrueTime{} : TrueTime{} + kBeforeFirstCycle;
  settings.faulty = evaluation::faults::named_by(fault, cluster);
  settings.from = faults::changes_schedule(fault) ? TrueTime{} : origin + fault.from;
  settings.until = fault.duration == faults::Fault::kToTheEnd ? sim::medium::Disturbance::kNever
                                                              : origin + fault.from + fault.duration;
  Trial trial(campaign, cluster, &drawn, starts_up, index, settings, story, bit_true);
  trial.run(end);
  const evaluation::faults::Judgement& judgement = trial.finish();
  if (story != nullptr) story->judged(judgement);
  FaultOutcome outcome = outcome_of(judgement, trial.activation());
  outcome.starts_without = starts_without;
  return outcome;
}

}  // namespace ttf::experiments::campaign
