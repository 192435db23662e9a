// Puts a plan of faults to work in a simulation: each fault acts in the medium, the clock or the supply, never
// in a node.
//
//   L1  the same plan, seed, replication and simulation give the same signals and the same records
//   L2  a fault's draws do not depend on the other faults of the plan
//   L3  without faults the simulation is bit for bit the same as without an injector
//   L4  nothing here allocates after construction, and nothing throws
//
// Faults are asked in the plan's order; each gets a signal as the faults before it left it. Faults of a node's
// own frames do not change the signals that faults emit in its name. A deaf receiver and a transient treat
// emitted signals like all others.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "faults/plan.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"
#include "sim/engine/plant.h"
#include "sim/faults/active_fault.h"
#include "sim/medium/disturbance.h"

namespace ttf::sim::faults {

class Injector final : public medium::Disturbance, private FaultLog {
 public:
  // `plan` is resolved for the cluster; its times count from `origin`. All arguments but the plan outlive the
  // injector. The simulation gets the injector by set_disturbance(), and at its construction the schedules that
  // its nodes believe in (faults/believed_schedule.h).
  Injector(ttf::faults::FaultPlan plan, const schedules::model::Cluster& cluster, engine::Plant& plant,
           std::uint64_t seed, std::uint32_t replication, recording::records::Sink& sink, TrueTime origin = {});
  ~Injector() override;

  // The number of a fault's effects, by its index in the plan: a signal changed, made or withheld, a supply or
  // a clock changed.
  struct Activation {
    std::uint64_t times = 0;
    TrueTime first{}, last{};  // valid if times > 0
  };
  std::span<const Activation> activations() const { return activations_; }

  bool touches(NodeId sender, schedules::model::Channel channel) const override;
  bool leaving(medium::Leaving& signal) override;
  bool arriving(medium::Arriving& signal) override;
  TrueTime next() const override { return next_; }
  void act(TrueTime now) override;
  bool touches_can(std::size_t bus, TrueTime until) const override;
  bool queues_on_can(std::size_t bus, NodeId sender) override;
  void begins_on_can(medium::CanBeginning& frame) override;
  bool arrives_from_can(std::size_t bus, NodeId receiver) override;
  bool acknowledges_on_can(std::size_t bus, NodeId node) override;
  TrueTime holds_can(std::size_t bus) const override;

 private:
  // One fault, with its begin and its end while they are to come.
  struct Entry {
    std::unique_ptr<ActiveFault> fault;
    TrueTime begins, ends;
  };
  // An effect that is recorded only when its fault begins.
  struct Foreseen {
    std::uint32_t fault = 0;
    std::array<char, kMostText> text{};
    std::size_t size = 0;
  };
  static constexpr std::size_t kForeseen = 64;  // room for some signals of one propagation delay
  void acted(std::uint32_t fault, TrueTime at, std::string_view text) override;
  void emit(const medium::Leaving& signal, std::optional<NodeId> source) override;
  void report(std::size_t fault, recording::records::FaultAct what, TrueTime at, std::string_view text);
  void begin(std::size_t fault, TrueTime at);
  void plan_next();

  ttf::faults::FaultPlan plan_;
  const schedules::model::Cluster& cluster_;
  engine::Plant& plant_;
  recording::records::Sink& sink_;
  std::vector<Entry> entries_;  // by index in the plan, like the vectors below
  std::vector<Activation> activations_;
  std::vector<Foreseen> foreseen_;
  TrueTime next_ = kNever<TrueTime>;
};

}  // namespace ttf::sim::faults
