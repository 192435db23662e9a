// One simulation of a cluster for a trial, with a fault or without. It has controllers on drawn clocks, hosts
// that write their lists, and the judge. The judge receives the records of controllers and guardians.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/faults/judge.h"
#include "experiments/campaign/file.h"
#include "experiments/campaign/flexray/trial.h"
#include "faults/believed_schedule.h"
#include "faults/plan.h"
#include "recording/records/records.h"
#include "sim/engine/bus_simulation.h"
#include "sim/engine/plant.h"
#include "sim/faults/injector.h"
#include "sim/medium/disturbance.h"

namespace ttf::experiments::campaign::flexray {

// The setting, with or without a fault. All of it must outlive the TrialSimulation.
struct TrialSetting {
  const CampaignFile& campaign;
  const schedules::model::Cluster& cluster;  // as wired
  std::uint32_t index = 0;
  bool bit_true = false;  // the medium encodes and decodes every frame
};

// Returns when cycle 0 begins, in a start-up or in a running cluster.
TrueTime trial_origin(bool starts_up);

class TrialSimulation final : public sim::medium::Disturbance,
                              public sim::engine::Plant,
                              public recording::records::Sink {
 public:
  // `fault`: absent for the same simulation without one. `story` may be null.
  TrialSimulation(const TrialSetting& setting, const std::optional<faults::Fault>& fault,
                  const evaluation::faults::JudgeSettings& judge, TrialStory* story = nullptr);
  ~TrialSimulation() override;

  void run_until(TrueTime end);
  // Returns the instant, to a quarter of a cycle; absent if some node is not active by `end`.
  std::optional<TrueTime> run_until_all_active(TrueTime end);
  const evaluation::faults::Judgement& finish() { return judge_.finish(simulation_->now()); }
  const sim::faults::Injector::Activation& activation() const { return injector_->activations().front(); }

 private:
  class Witness;
  void state_changed(NodeId node, bus::poc::PocKind from, const bus::poc::PocStep& step);
  // As its record has it, but at the simulation's own time.
  recording::records::Stamp stamp(NodeId node) const { return {now(), {}, {}, node}; }
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

  // The plant: the judge is informed of lost supplies.
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
  std::unique_ptr<sim::engine::BusSimulation> simulation_;
  std::unique_ptr<sim::faults::Injector> injector_;
};

}  // namespace ttf::experiments::campaign::flexray
