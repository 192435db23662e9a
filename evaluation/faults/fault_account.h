// The account of a drive's faults: their injections, the checks that saw them and in how many cycles, the signals
// that guardians stopped, the nodes that changed state, and harms to fault-free nodes. It uses the fault plan and
// the records alone, so a live drive and its log give the same report.
//
// Checks and harms are those of evaluation/faults/checks.h. Records hold a little less than a simulation shows
// the judge of single faults (evaluation/faults/judge.h):
//   - a node is fault-free until a fault that names it begins
//   - H3 follows from the starts of frames (evaluation/faults/frame_clocks.h), H4 and H5 from reports about slots
//     (evaluation/faults/slot_ledger.h), in the static segment
// A starting node's steps forwards have no cause; its steps back have one, and so do all its steps after a
// fault took its supply. A finding or a harm belongs to the fault that it fits (evaluation/faults/causes.h), or
// is unattributed. Nothing counts before the first fault has begun.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/faults/causes.h"
#include "evaluation/faults/checks.h"
#include "evaluation/faults/frame_clocks.h"
#include "evaluation/faults/injected_fault.h"
#include "evaluation/faults/slot_ledger.h"
#include "evaluation/faults/standings.h"
#include "faults/plan.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

// One check, as seen by the nodes of one side: the fault-free ones, or the others.
struct CheckSeen {
  std::uint64_t cycles = 0;         // with a finding
  TrueTime first{};                 // valid if cycles > 0
  std::vector<NodeId> nodes;        // in the order of their first findings; a guardian is no node
  std::array<bool, 2> guardians{};  // by channel
};

struct StateSeen {
  NodeId node{};
  std::string from, to, why;  // as at the first time; `to` is "without supply" or "with supply" after a change
                              // of power
  TrueTime first{};
  std::uint64_t times = 0;
};

// Bus signals that guardians blocked or cut for one reason, in the words of the records.
struct GuardianSeen {
  bool cut = false;  // else blocked
  std::string why;
  std::uint64_t signals = 0;
  std::int64_t first_cycle = 0;  // running cycle
  TrueTime first{};
};

struct HarmSeen {
  NodeId node = kNoNode;  // kNoNode: the precision is harmed
  TrueTime first{};
  NodeId sender = kNoNode;  // the frame's, if the harm is about one
  int slot = 0;
  std::uint64_t times = 0;
};

// The effects of one fault, or those without a cause.
struct FaultEffects {
  std::array<CheckSeen, kAllChecks.size()> by_others, by_faulty;  // by Check
  std::vector<GuardianSeen> guardians;
  std::vector<StateSeen> states;
  std::array<std::vector<HarmSeen>, kAllHarms.size()> harms;  // by Harm, every harmed node once
  bool harmed() const;
  bool nothing() const;  // no check saw it and no node changed
};

struct FaultSeen : FaultEffects, InjectedFault {};

// The errors of one controller on a private CAN, from the first fault's begin on. A fault on the CAN is their cause, or
// a node without supply; they are not distinguished.
struct CanSeen {
  std::uint8_t bus = 0;
  NodeId node = kNoNode;
  static constexpr std::size_t kErrors = 1 + index_of(recording::records::CanError::kAcknowledgement);
  std::array<std::uint64_t, kErrors> errors{};  // error frames that it began, by error
  std::uint64_t passive = 0, bus_off = 0;       // changes into these states
  TrueTime first{};
};

struct FaultFindings {
  std::vector<FaultSeen> faults;  // those of the plan that began, in that order
  FaultEffects unattributed;      // effects that fit none of them
  std::vector<CanSeen> cans;      // by CAN and node; controllers with errors only
  bool harmed() const;
};

class FaultAccount final : public recording::records::Sink {
 public:
  // `plan` is the drive's, resolved for the cluster. `begins_integrated`: the nodes are in normal operation
  // from the start; else they have no supply until their records say so.
  FaultAccount(const schedules::model::Cluster& cluster, ttf::faults::FaultPlan plan, bool begins_integrated);
  FaultAccount(const FaultAccount&) = delete;
  FaultAccount& operator=(const FaultAccount&) = delete;

  // Ends the drive and settles the open cycles. In a drive that began with start-up, a fault-free node that
  // never became normal active is harmed (H2).
  void finish(TrueTime at);
  const FaultFindings& findings() const { return findings_; }

  using recording::records::Sink::on;
  void on(const recording::records::FaultActivity&) override;
  void on(const recording::records::StateChanged&) override;
  void on(const recording::records::PowerChanged&) override;
  void on(const recording::records::SlotProblem&) override;
  void on(const recording::records::ClockCorrected&) override;
  void on(const recording::records::SlotFrameSent&) override;
  void on(const recording::records::GuardianIntervention&) override;
  void on(const recording::records::CanErrorFrame&) override;
  void on(const recording::records::CanStateChanged&) override;

 private:
  using Cause = FaultCauses::Cause;
  // A cycle counts once, however many nodes and slots it has findings about: indexed by its counter, which
  // comes again after a round.
  using Counted = std::array<std::array<std::optional<TrueTime>, schedules::model::kMostCycles>, 2 * kAllChecks.size()>;

  bool has(NodeId node) const { return index_of(node) < standings_.size(); }  // a log may be of another cluster
  // A starting node takes these steps in any case, so only those back have a cause.
  bool starts_as_planned(NodeId node) const { return standings_.has_to_start(node) && !cut_off_[index_of(node)]; }
  FaultEffects& effects(Cause cause);
  CanSeen* can_seen(std::uint8_t bus, const recording::records::Stamp& stamp);
  std::int64_t cycle_at(TrueTime at) const;
  CheckSeen& notice(Cause cause, Check check, bool faulty, std::int64_t cycle, TrueTime at);
  void notice(Cause cause, Check check, NodeId node, std::int64_t cycle, TrueTime at);
  void changed(Cause cause, NodeId node, std::string_view from, std::string_view to, std::string_view why, TrueTime at);
  void left_active(Cause cause, NodeId node, TrueTime at);
  void lost(const SlotLoss& loss);
  void harm(Cause cause, Harm harm, TrueTime at, NodeId node, NodeId sender = kNoNode, int slot = 0);

  const schedules::model::Cluster& cluster_;
  const ttf::faults::FaultPlan plan_;
  Duration cycle_, slot_, action_point_, assumed_precision_;
  Standings standings_;
  std::vector<bool> cut_off_;  // by NodeId: a fault has taken its supply, or withholds it
  FaultCauses causes_;
  FrameClocks clocks_;
  SlotLedger ledger_;
  // The newest known cycle, by a fault-free node's clock.
  std::optional<std::pair<TrueTime, std::int64_t>> cycle_began_;
  FaultFindings findings_;
  std::vector<std::optional<std::size_t>> place_;  // in findings_.faults, by index in the plan
  std::vector<Counted> counted_;                   // by index in the plan; the last: unattributed
};

}  // namespace ttf::evaluation::faults
