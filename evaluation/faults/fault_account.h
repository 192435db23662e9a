// What the faults of a run did: injected, seen by which check and in how many cycles, kept from the others by the
// guardians, which nodes changed state, and whether a node without a fault was harmed. From the fault plan and the
// records alone, so that a live run's report and its log's are the same.
//
// Checks and harms are those of evaluation/faults/checks.h. Where the judge of single faults
// (evaluation/faults/judge.h) looks on from inside a simulation, records tell a little less:
//   - a node is without a fault until a fault that names it begins
//   - H3 is told from when frames begin (evaluation/faults/frame_clocks.h), H4 and H5 from who reports which slot
//     (evaluation/faults/slot_ledger.h), in the static segment
// Of a node that has to start, the steps on its way are nobody's doing, only those back are, and all once a fault took
// its supply. What is seen or harmed belongs to the fault that it fits (evaluation/faults/causes.h), or is
// unattributed. Nothing counts before the first fault has begun.
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
#include "evaluation/faults/slot_ledger.h"
#include "evaluation/faults/standings.h"
#include "faults/plan.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

// One check, as seen by nodes of one side: those without a fault, or those with one.
struct CheckSeen {
  std::uint64_t cycles = 0;         // in which it was seen
  TrueTime first{};                 // where there are any
  std::vector<NodeId> nodes;        // in the order in which they saw it first; a guardian is no node
  std::array<bool, 2> guardians{};  // by channel
};

struct StateSeen {
  NodeId node{};
  std::string from, to, why;  // as at the first time; to "without supply", "with supply" where its power went or came
  TrueTime first{};
  std::uint64_t times = 0;
};

// What guardians kept from the others for one reason, in the words of the records.
struct GuardianSeen {
  bool cut = false;  // else blocked
  std::string why;
  std::uint64_t signals = 0;
  std::int64_t first_cycle = 0;  // running cycle
  TrueTime first{};
};

struct HarmSeen {
  NodeId node = kNoNode;  // the harmed one; kNoNode: of the precision
  TrueTime first{};
  NodeId sender = kNoNode;  // whose frame it was about at the first time, where it was about one
  int slot = 0;
  std::uint64_t times = 0;
};

// What came of one fault, or of none.
struct FaultEffects {
  std::array<CheckSeen, kAllChecks.size()> by_others, by_faulty;  // by Check
  std::vector<GuardianSeen> guardians;
  std::vector<StateSeen> states;
  std::array<std::vector<HarmSeen>, kAllHarms.size()> harms;  // by Harm, every harmed node once
  bool harmed() const;
  bool nothing() const;  // nobody saw anything, nothing changed
};

struct FaultSeen : FaultEffects {
  std::uint32_t fault = 0;  // index in the plan
  std::string kind, text;   // as the plan names it; what it did first, empty if nothing
  NodeId node = kNoNode;    // kNoNode: the medium's
  TrueTime begins{};
  std::optional<TrueTime> ends, first_act;
  std::uint64_t acts = 0;
};

struct FaultFindings {
  std::vector<FaultSeen> faults;  // as many of the plan's as began, in that order
  FaultEffects unattributed;      // what fits none of them
  bool harmed() const;
};

class FaultAccount final : public recording::records::Sink {
 public:
  // `plan`: resolved for the cluster, and the run's. `begins_integrated`: the nodes are in normal operation from the
  // start; else they have no supply until they say so.
  FaultAccount(const schedules::model::Cluster& cluster, ttf::faults::FaultPlan plan, bool begins_integrated);
  FaultAccount(const FaultAccount&) = delete;
  FaultAccount& operator=(const FaultAccount&) = delete;

  // The run is over: what is open is settled. Who has not become normal active since the beginning is harmed (H2), if
  // the run began with start-up.
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

 private:
  using Cause = FaultCauses::Cause;
  // A cycle is counted once however many nodes and slots it is about: by its counter, where that comes again after a
  // round.
  using Counted = std::array<std::array<std::optional<TrueTime>, 64>, 2 * kAllChecks.size()>;

  bool knows(NodeId node) const { return index_of(node) < standings_.size(); }  // a log may be of another cluster
  // Whatever is at fault, it would take these steps: only those back are anybody's doing.
  bool starts_as_planned(NodeId node) const { return standings_.has_to_start(node) && !cut_off_[index_of(node)]; }
  FaultEffects& effects(Cause cause);
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
  std::vector<bool> cut_off_;  // by NodeId: a fault has taken its supply, or keeps it
  FaultCauses causes_;
  FrameClocks clocks_;
  SlotLedger ledger_;
  // The newest cycle known, by a fault-free node's clock.
  std::optional<std::pair<TrueTime, std::int64_t>> cycle_began_;
  FaultFindings findings_;
  std::vector<std::optional<std::size_t>> place_;  // in findings_.faults, by index in the plan
  std::vector<Counted> counted_;                   // by index in the plan, and of what is unattributed
};

}  // namespace ttf::evaluation::faults
