// Judges whether a single fault harmed fault-free nodes, and which checks noticed it (checks.h). It uses the
// controllers' reports to their hosts and the difference of the clocks. frame_ledger.h defines overdue frames.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bus/controller/controller.h"
#include "core/ids.h"
#include "core/time.h"
#include "evaluation/faults/checks.h"
#include "evaluation/faults/frame_ledger.h"
#include "evaluation/faults/judgement.h"
#include "evaluation/faults/standings.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

using FlexRayJudgeBase = JudgeOf<Check, kAllChecks.size(), Harm, kAllHarms.size()>;
using Judgement = FlexRayJudgeBase::Judgement;

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

class FaultJudge : private FlexRayJudgeBase {
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
  void notice(Check check, NodeId by, TrueTime at);
  void left_active(NodeId node, TrueTime at);

  JudgeSettings settings_;
  Standings standings_;
  FrameLedger ledger_;
};

}  // namespace ttf::evaluation::faults
