#include "experiments/campaign/flexray/trial_simulation.h"

#include <algorithm>
#include <utility>

#include "experiments/campaign/flexray/trial_draws.h"
#include "experiments/campaign/flexray/trial_host.h"
#include "sim/engine/clock_spread.h"

namespace ttf::experiments::campaign::flexray {
namespace {

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

TrueTime trial_origin(bool starts_up) { return starts_up ? TrueTime{} : TrueTime{} + kBeforeFirstCycle; }

// Passes a controller's events to the judge, and lets the host write its next lists.
class TrialSimulation::Witness final : public bus::controller::ControllerEvents {
 public:
  Witness(TrialSimulation& trial, NodeId node) : trial_(trial), node_(node), host_(trial.setting_.cluster, node) {}

  void cycle_started(std::int64_t cycle, Microticks) override {
    host_.write(trial_.simulation_->controller(node_), cycle);
  }
  void slot_problem(std::int64_t, int, Channel, bus::controller::SlotStatus status, Microticks) override {
    trial_.judge_.slot_problem(node_, status, trial_.now());
  }
  void frame_sent(const bus::ports::Transmission& sent, std::int64_t, bool, PduId, std::uint32_t, int, bool) override {
    trial_.judge_.frame_sent(node_, sent.slot, sent.channel, sent.content, trial_.now());
  }
  bool wants_bytes() const override { return false; }
  void frame_received(std::int64_t, int slot, Channel channel, const bus::wire::DecodedFrame& frame,
                      Microticks) override {
    trial_.judge_.frame_received(node_, slot, channel, frame, trial_.now());
  }
  void clock_corrected(std::int64_t, const timebase::Correction& offset, const timebase::Correction& rate,
                       Microticks) override {
    trial_.judge_.clock_corrected(node_, offset.missing || rate.missing, offset.limit_reached || rate.limit_reached,
                                  trial_.now());
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
        judge_.guardian_intervened(intervention.at);
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
  judge_.state_changed(node, from, step.next.kind, now());
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
  judge_.lost_supply(node, now());
  simulation_->power_off(node);
}

void TrialSimulation::on(const recording::records::FaultActivity& activity) {
  if (story_ != nullptr) story_->fault_acts(activity);
}

}  // namespace ttf::experiments::campaign::flexray
