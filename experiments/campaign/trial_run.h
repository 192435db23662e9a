// One run of a cluster for a trial: controllers on drawn clocks with hosts that write their lists, with a fault or
// without, and the judge, who is told what controllers and guardians report.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/faults/judge.h"
#include "experiments/campaign/file.h"
#include "experiments/campaign/trial_story.h"
#include "faults/believed_schedule.h"
#include "faults/plan.h"
#include "recording/records/records.h"
#include "sim/crank/bus_simulation.h"
#include "sim/crank/plant.h"
#include "sim/faults/injector.h"
#include "sim/medium/disturbance.h"

namespace ttf::experiments::campaign {

// What does not depend on whether there is a fault. All of it outlives the run.
struct TrialSetting {
  const CampaignFile& campaign;
  const schedules::model::Cluster& cluster;  // as wired
  std::uint32_t index = 0;
  bool bit_true = false;  // a medium that encodes and decodes every frame
};

// When cycle 0 begins, of a start-up or of a cluster that runs.
TrueTime trial_origin(bool starts_up);

class TrialRun final : public sim::medium::Disturbance, public sim::crank::Plant, public recording::records::Sink {
 public:
  // `fault`: none for the same run without one. `story` may be null.
  TrialRun(const TrialSetting& setting, const std::optional<faults::Fault>& fault,
           const evaluation::faults::JudgeSettings& judge, TrialStory* story = nullptr);
  ~TrialRun() override;

  void run_until(TrueTime end);
  // When they are: to a quarter of a cycle. Nothing if they are not by `end`.
  std::optional<TrueTime> run_until_all_active(TrueTime end);
  const evaluation::faults::Judgement& finish() { return judge_.finish(simulation_->now()); }
  const sim::faults::Injector::Activation& activation() const { return injector_->activations().front(); }

 private:
  class Witness;
  void state_changed(NodeId node, bus::poc::PocKind from, const bus::poc::PocStep& step);
  void sample_precision();
  void restart_halted(TrueTime at);

  // The disturbance: the fault, and hosts that restart halted controllers.
  bool touches(NodeId sender, schedules::model::Channel channel) const override {
    return injector_->touches(sender, channel);
  }
  bool leaving(sim::medium::Leaving& signal) override { return injector_->leaving(signal); }
  bool arriving(sim::medium::Arriving& signal) override { return injector_->arriving(signal); }
  TrueTime next() const override;
  void act(TrueTime at) override;

  // The plant: who loses its supply is told to the judge.
  TrueTime now() const override { return simulation_->now(); }
  bool powered(NodeId node) const override { return simulation_->powered(node); }
  void power_off(NodeId node) override;
  void power_on(NodeId node, TrueTime at) override { simulation_->power_on(node, at); }
  void change_drift(NodeId node, std::int64_t ppb) override { simulation_->change_drift(node, ppb); }
  void emit(const sim::medium::Leaving& signal, std::optional<NodeId> source) override {
    simulation_->emit(signal, source);
  }

  using recording::records::Sink::on;
  void on(const recording::records::FaultActivity& activity) override;

  const TrialSetting setting_;
  const faults::FaultPlan plan_;
  const faults::BelievedSchedules believed_;
  const std::vector<bool> faulty_;  // by NodeId
  evaluation::faults::FaultJudge judge_;
  TrialStory* story_;
  std::vector<TrueTime> restart_at_;  // by NodeId
  std::vector<std::unique_ptr<Witness>> witnesses_;
  std::unique_ptr<sim::crank::BusSimulation> simulation_;
  std::unique_ptr<sim::faults::Injector> injector_;
};

}  // namespace ttf::experiments::campaign
