// Judges whether a single fault harmed fault-free nodes, and which checks noticed it (checks.h). It uses the
// controllers' reports to their hosts and the difference of the clocks. frame_ledger.h defines overdue frames.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bus/controller/controller.h"
#include "core/ids.h"
#include "core/time.h"
#include "evaluation/faults/checks.h"
#include "evaluation/faults/frame_ledger.h"
#include "evaluation/faults/standings.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

// The judge's findings.
struct Judgement {
  using Since = std::optional<TrueTime>;                  // the first time, if any
  std::array<Since, kAllChecks.size()> seen_by_others{};  // by Check
  std::array<Since, kAllChecks.size()> seen_by_itself{};  // by the faulty node's own controller
  struct Harmed {
    TrueTime first{};
    NodeId node = kNoNode;    // kNoNode: the precision is harmed
    NodeId sender = kNoNode;  // the frame's
    int slot = 0;
  };
  std::array<std::optional<Harmed>, kAllHarms.size()> harms{};  // by Harm
  Since passive, halt;                                          // any node's, the faulty one included
  // Nodes that lost normal active or their supply: the longest time until one was normal active again, and the
  // number of nodes that did not come back. The time counts from the loss or the end of the fault, whichever
  // was later.
  std::optional<Duration> reintegration;
  int still_out = 0;

  bool harmed() const;
  Since detected() const;  // by others
};

struct JudgeSettings {
  std::vector<bool> faulty;  // by NodeId: named by the fault
  TrueTime from{};           // beginning of the fault: nothing counts before
  TrueTime until{};          // its end
  Duration assumed_precision{};
  bool starts_up = false;  // the drive begins with start-up, so all fault-free nodes have to become active
  // Until `settled`, checks in `usual` do not count: the same start-up without the fault shows them, too.
  TrueTime settled{};
  std::array<bool, kAllChecks.size()> usual{};
};

class FaultJudge {
 public:
  // Nodes are in normal operation if the drive begins so; else they have no supply.
  FaultJudge(const schedules::model::Cluster& cluster, JudgeSettings settings);
  FaultJudge(const FaultJudge&) = delete;
  FaultJudge& operator=(const FaultJudge&) = delete;

  // Events, in the order of time.
  void state_changed(NodeId node, bus::poc::PocKind from, bus::poc::PocKind to, TrueTime at);
  void lost_supply(NodeId node, TrueTime at) { left_active(node, at); }
  void slot_problem(NodeId node, bus::controller::SlotStatus status, TrueTime at);
  void clock_corrected(NodeId node, bool missing, bool limit_reached, TrueTime at);
  // `frame` is valid during the call only.
  void frame_sent(NodeId node, int slot, schedules::model::Channel channel, const bus::wire::DecodedFrame& frame,
                  TrueTime at) {
    ledger_.sent(node, slot, channel, frame, at);
  }
  void frame_received(NodeId node, int slot, schedules::model::Channel channel, const bus::wire::DecodedFrame& frame,
                      TrueTime at) {
    ledger_.received(node, slot, channel, frame, at);
  }
  void guardian_intervened(TrueTime at) { notice(Check::kGuardian, kNoNode, at); }
  // The difference among the synchronised fault-free nodes.
  void precision(Duration apart, TrueTime at);

  bool all_fault_free_active() const { return standings_.all_fault_free_active(); }
  // Returns the judgement if no further event comes until `at`.
  const Judgement& finish(TrueTime at);

 private:
  bool counts(TrueTime at) const { return at >= settings_.from; }
  void notice(Check check, NodeId by, TrueTime at);
  void harm(Harm harm, TrueTime at, NodeId node, NodeId sender = kNoNode, int slot = 0);
  void left_active(NodeId node, TrueTime at);
  void came_back(NodeId node, TrueTime at);

  JudgeSettings settings_;
  Standings standings_;
  std::vector<std::optional<TrueTime>> out_since_;  // by NodeId: lost normal active, or its supply
  FrameLedger ledger_;
  Judgement judgement_;
};

}  // namespace ttf::evaluation::faults
