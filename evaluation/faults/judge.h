// Judges whether a single fault harmed fault-free nodes, and which checks noticed it (checks.h), from the records of a
// trial.
//
// H3 to H5 use what no record holds: the clocks' difference at sampled instants, and the frames as they were received
// (frame_ledger.h). Records alone, as in a drive's account (fault_account.h), miss some of these harms, forged
// frames above all, and take some frames for lost that came.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/faults/checks.h"
#include "evaluation/faults/frame_ledger.h"
#include "evaluation/faults/judgement.h"
#include "evaluation/faults/standings.h"
#include "recording/records/records.h"
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

class FaultJudge final : public recording::records::Sink, private FlexRayJudgeBase {
 public:
  // Nodes are in normal operation if the drive begins so; else they have no supply.
  FaultJudge(const schedules::model::Cluster& cluster, JudgeSettings settings);
  FaultJudge(const FaultJudge&) = delete;
  FaultJudge& operator=(const FaultJudge&) = delete;

  // Records and events come in the order of time.
  using recording::records::Sink::on;
  void on(const recording::records::StateChanged&) override;
  void on(const recording::records::PowerChanged&) override;
  void on(const recording::records::SlotProblem& problem) override { notice(problem); }
  void on(const recording::records::ClockCorrected& corrected) override { notice(corrected); }
  void on(const recording::records::GuardianIntervention& kept) override { notice(Check::kGuardian, kNoNode, kept.at); }
  // `frame` is valid during the call only.
  void frame_sent(NodeId node, int slot, schedules::model::Channel channel, const bus::wire::DecodedFrame& frame,
                  TrueTime at) {
    ledger_.sent(node, slot, channel, frame, at);
  }
  void frame_received(NodeId node, int slot, schedules::model::Channel channel, const bus::wire::DecodedFrame& frame,
                      TrueTime at) {
    ledger_.received(node, slot, channel, frame, at);
  }
  // The difference among the synchronised fault-free nodes.
  void precision(Duration apart, TrueTime at);

  bool all_fault_free_active() const { return standings_.all_fault_free_active(); }
  // Returns the judgement if no further event comes until `at`.
  const Judgement& finish(TrueTime at);

 private:
  void notice(Check check, NodeId by, TrueTime at);
  template <class Record> void notice(const Record& record) {
    for_each_check(record, [&](Check check) { notice(check, record.stamp.node, record.stamp.true_time); });
  }
  void left_active(NodeId node, TrueTime at);

  JudgeSettings settings_;
  Standings standings_;
  FrameLedger ledger_;
};

}  // namespace ttf::evaluation::faults
