#include "experiments/campaign/flexray/trial_simulation.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "bus/controller/controller.h"
#include "core/ids.h"
#include "core/random.h"
#include "core/time.h"
#include "experiments/campaign/full_list.h"
#include "schedules/model/cluster.h"
#include "sim/engine/bus_simulation.h"
#include "sim/engine/clock_spread.h"
#include "sim/medium/star_coupler.h"
#include "timebase/oscillator.h"

namespace ttf::experiments::campaign::flexray {
namespace {

constexpr int kCyclesToPowerOn = 2;  // all nodes, in a start-up
constexpr std::int64_t kGuardianDriftPpb = 1'500'000, kIdleMicrotick_ps = 25'000;

// Draws a trial's cluster: the clocks of nodes and guardians, and the instants of power-on. A pure function of
// the campaign's seed and the trial's index.
class TrialDraws {
 public:
  TrialDraws(std::uint64_t seed, std::uint32_t index, const schedules::model::Cluster& cluster)
      : seed_(seed), index_(index), cluster_(cluster) {}

  // Nodes by NodeId: powered on within some cycles, or integrated in a cluster whose cycle 0 starts at
  // `origin`.
  std::vector<sim::engine::BusNode> starting() const {
    std::vector<sim::engine::BusNode> nodes;
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
      const std::int64_t latest = cluster_.cycle().ns * kCyclesToPowerOn;
      nodes.push_back(node(n));
      nodes.back().power_on = TrueTime{stream(Purpose::kCampaign, n + 1).integer(0, latest)};
    }
    return nodes;
  }
  // The rate correction cancels the drift to a microtick per cycle, as after start-up.
  std::vector<sim::engine::BusNode> integrated(TrueTime origin) const {
    std::vector<sim::engine::BusNode> nodes;
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
      sim::engine::BusNode& made = nodes.emplace_back(node(n));
      const Microticks begins = made.oscillator.ticks_at(origin);
      const std::int64_t thousand = (made.oscillator.ticks_at(origin + cluster_.cycle() * 1000) - begins).value;
      made.clock = {begins + Microticks{1},
                    static_cast<int>((thousand + 500) / 1000 - cluster_.nodes[n].flexray->pMicroPerCycle)};
    }
    return nodes;
  }
  std::vector<timebase::Oscillator> guardians() const {  // by channel
    std::vector<timebase::Oscillator> guardians;
    for (const schedules::model::Channel channel : schedules::model::kBothChannels) {
      const bool needed = sim::medium::StarCoupler::needed(cluster_, channel);
      guardians.push_back(
          oscillator(cluster_.nodes.size() + index_of(channel),
                     needed ? sim::medium::StarCoupler::microtick_ps(cluster_, channel) : kIdleMicrotick_ps,
                     std::nullopt, kGuardianDriftPpb));
    }
    return guardians;
  }

 private:
  RandomStream stream(Purpose purpose, std::size_t entity) const {
    return RandomStream({seed_, index_, purpose, static_cast<std::uint16_t>(entity), 0});
  }
  timebase::Oscillator oscillator(std::size_t entity, std::int64_t microtick_ps, std::optional<std::int64_t> fixed_ppb,
                                  std::int64_t most_ppb) const {
    RandomStream draw = stream(Purpose::kClockDrift, entity);
    const std::int64_t ppb = draw.integer(-most_ppb, most_ppb);
    return {microtick_ps, fixed_ppb.value_or(ppb), draw.integer(0, microtick_ps - 1)};
  }
  sim::engine::BusNode node(std::size_t n) const {
    const schedules::model::Node& node = cluster_.nodes[n];
    return {oscillator(n, node.microtick_ps, node.drift_ppb, node.max_drift_ppb)};
  }

  std::uint64_t seed_;
  std::uint32_t index_;
  const schedules::model::Cluster& cluster_;
};

using bus::poc::PocKind;
using schedules::model::Channel;

constexpr Duration kBeforeFirstCycle = Duration::milliseconds(1);  // in a running cluster
constexpr int kSamplesPerCycle = 4;                                // for the precision

faults::FaultPlan plan_of(const CampaignFile& campaign, const std::optional<faults::Fault>& fault) {
  faults::FaultPlan plan{campaign.file, {}};
  if (fault) plan.faults.push_back(*fault);
  return plan;
}

}  // namespace

// The host of one node in a trial: writes its lists and its network management vector anew in every cycle, so
// that all frames differ.
class TrialHost {
 public:
  TrialHost(const schedules::model::Cluster& cluster, NodeId node) : cluster_(cluster), node_(node) {
    for (const schedules::model::FrameSlot& frame : cluster.frames)
      if (frame.sender == node && frame.pdu != kNoPdu &&
          std::find(pdus_.begin(), pdus_.end(), frame.pdu) == pdus_.end())
        pdus_.push_back(frame.pdu);
    vector_.resize(static_cast<std::size_t>(cluster.flexray.gNetworkManagementVectorLength));
  }
  void write(bus::controller::FlexRayController& controller, std::int64_t cycle) {
    for (const PduId pdu : pdus_) write_list(controller, pdu, cycle);
    if (!vector_.empty()) write_vector(controller, cycle);
  }

 private:
  void write_list(bus::controller::FlexRayController& controller, PduId pdu, std::int64_t cycle) {
    controller.outgoing(pdu).write(full_list(cluster_.pdu(pdu), static_cast<std::uint32_t>(cycle), list_));
  }
  void write_vector(bus::controller::FlexRayController& controller, std::int64_t cycle) {
    vector_.front() = static_cast<std::byte>(index_of(node_) + 1);
    vector_.back() = static_cast<std::byte>(cycle & 0xff);
    controller.set_network_management_vector(vector_);
  }

  const schedules::model::Cluster& cluster_;
  NodeId node_;
  std::vector<PduId> pdus_;
  std::vector<std::byte> list_, vector_;
};

TrueTime trial_origin(bool starts_up) { return starts_up ? TrueTime{} : TrueTime{} + kBeforeFirstCycle; }

// Passes a controller's events to the judge, and lets the host write its next lists.
class TrialSimulation::Witness final : public bus::controller::ControllerEvents {
 public:
  Witness(TrialSimulation& trial, NodeId node) : trial_(trial), node_(node), host_(trial.setting_.cluster, node) {}

  void cycle_started(std::int64_t cycle, Microticks) override {
    host_.write(trial_.simulation_->controller(node_), cycle);
  }
  void slot_problem(std::int64_t cycle, int slot, Channel channel, bus::controller::SlotStatus status,
                    Microticks) override {
    trial_.judge_.on(recording::records::SlotProblem{trial_.stamp(node_), cycle, static_cast<std::uint16_t>(slot),
                                                     static_cast<std::uint8_t>(channel), status});
  }
  void frame_sent(const bus::ports::Transmission& sent, std::int64_t, bool, PduId, std::uint32_t, int, bool) override {
    trial_.judge_.frame_sent(node_, sent.slot, sent.channel, sent.content, trial_.now());
  }
  bool wants_bytes() const override { return false; }
  void frame_received(std::int64_t, int slot, Channel channel, const bus::wire::DecodedFrame& frame,
                      Microticks) override {
    trial_.judge_.frame_received(node_, slot, channel, frame, trial_.now());
  }
  void clock_corrected(std::int64_t cycle, const timebase::Correction& offset, const timebase::Correction& rate,
                       Microticks) override {
    trial_.judge_.on(recording::records::ClockCorrected{trial_.stamp(node_), cycle, offset.value, rate.value,
                                                        offset.missing, rate.missing, offset.limit_reached,
                                                        rate.limit_reached});
  }
  void state_changed(PocKind from, const bus::poc::PocStep& step, Microticks) override {
    trial_.state_changed(node_, from, step);
  }

 private:
  TrialSimulation& trial_;
  NodeId node_;
  TrialHost host_;
};

TrialSimulation::TrialSimulation(const TrialSetting& setting, const std::optional<faults::Fault>& fault,
                                 const evaluation::faults::JudgeSettings& judge, TrialStory* story)
    : setting_(setting), plan_(plan_of(setting.campaign, fault)), believed_(plan_, setting.cluster),
      faulty_(judge.faulty), judge_(setting.cluster, judge), story_(story),
      restart_at_(setting.cluster.nodes.size(), kNever<TrueTime>) {
  const CampaignFile& campaign = setting.campaign;
  const schedules::model::Cluster& cluster = setting.cluster;
  const TrueTime origin = trial_origin(judge.starts_up);
  const TrialDraws draws(campaign.seed, setting.index, cluster);
  std::vector<sim::engine::BusNode> nodes = judge.starts_up ? draws.starting() : draws.integrated(origin);
  std::vector<bus::controller::ControllerEvents*> events;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto node = static_cast<NodeId>(n);
    nodes[n].view = believed_.of(node);
    events.push_back(witnesses_.emplace_back(std::make_unique<Witness>(*this, node)).get());
  }
  simulation_ =
      std::make_unique<sim::engine::BusSimulation>(cluster, std::move(nodes), std::move(events), draws.guardians());
  injector_ =
      std::make_unique<sim::faults::Injector>(plan_, cluster, *this, campaign.seed, setting.index, *this, origin);
  simulation_->set_disturbance(this);
  simulation_->medium().set_transparent(!setting.bit_true);
  for (const Channel channel : schedules::model::kBothChannels)
    if (sim::medium::StarCoupler* coupler = simulation_->coupler(channel))
      coupler->on_intervention([this](const sim::medium::StarCoupler::Intervention& intervention) {
        judge_.on(recording::records::GuardianIntervention{.at = intervention.at, .why = {}});
        if (story_ != nullptr) story_->guardian_intervened(intervention);
      });
}

TrialSimulation::~TrialSimulation() = default;

void TrialSimulation::run_until(TrueTime end) {
  const Duration step{setting_.cluster.cycle().ns / kSamplesPerCycle};
  for (TrueTime at = now() + step; at <= end; at += step) {
    simulation_->run_until(at);
    sample_precision();
  }
}

std::optional<TrueTime> TrialSimulation::run_until_all_active(TrueTime end) {
  const Duration step{setting_.cluster.cycle().ns / kSamplesPerCycle};
  for (TrueTime at = now() + step; at <= end; at += step) {
    simulation_->run_until(at);
    if (judge_.all_fault_free_active()) return at;
  }
  return std::nullopt;
}

void TrialSimulation::state_changed(NodeId node, PocKind from, const bus::poc::PocStep& step) {
  judge_.on(recording::records::StateChanged{stamp(node), from, step.next.kind, {}, {}, {}, {}});
  if (story_ != nullptr) story_->state_changed(node, from, step, now());
  const int cycles = setting_.campaign.restart_halted_after;
  if (step.next.kind == PocKind::kHalt && cycles > 0)
    restart_at_[index_of(node)] = now() + setting_.cluster.cycle() * cycles;
}

void TrialSimulation::sample_precision() {
  sim::engine::ClockSpread spread(setting_.cluster);
  for (std::size_t n = 0; n < setting_.cluster.nodes.size(); ++n) {
    const auto node = static_cast<NodeId>(n);
    if (faulty_[n] || !powered(node) || !simulation_->controller(node).synchronised()) continue;
    const Microticks ticks = simulation_->oscillator(node).ticks_at(now());
    spread.add(simulation_->controller(node).clock()->global_time(ticks));
  }
  judge_.precision(spread.width(), now());
}

TrueTime TrialSimulation::next() const {
  return std::min(injector_->next(), *std::min_element(restart_at_.begin(), restart_at_.end()));
}

void TrialSimulation::act(TrueTime at) {
  if (injector_->next() <= at) injector_->act(at);
  restart_halted(at);
}

void TrialSimulation::restart_halted(TrueTime at) {
  for (std::size_t n = 0; n < restart_at_.size(); ++n) {
    if (restart_at_[n] > at) continue;
    restart_at_[n] = kNever<TrueTime>;
    const auto node = static_cast<NodeId>(n);
    if (!powered(node) || simulation_->controller(node).state().kind != PocKind::kHalt) continue;
    simulation_->power_off(node);
    simulation_->power_on(node, at);
  }
}

void TrialSimulation::power_off(NodeId node) {
  judge_.on(recording::records::PowerChanged{stamp(node), false});
  simulation_->power_off(node);
}

void TrialSimulation::on(const recording::records::FaultActivity& activity) {
  if (story_ != nullptr) story_->fault_acts(activity);
}

}  // namespace ttf::experiments::campaign::flexray
