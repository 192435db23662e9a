#include "evaluation/faults/judge.h"

#include <utility>

#include "core/check.h"

namespace ttf::evaluation::faults {

using bus::poc::PocKind;

FaultJudge::FaultJudge(const schedules::model::Cluster& cluster, JudgeSettings settings)
    : FlexRayJudgeBase(settings.from, settings.until, cluster.nodes.size()), settings_(std::move(settings)),
      standings_(cluster, !settings_.starts_up), ledger_(cluster, standings_, [this](const SlotLoss& loss) {
        harm(loss.forged ? Harm::kFrameForged : Harm::kFrameLost, loss.at, loss.receiver, loss.sender, loss.slot);
      }) {
  TTF_CHECK(settings_.faulty.size() == standings_.size(), "{} of {} nodes", settings_.faulty.size(), standings_.size());
  for (std::size_t n = 0; n < standings_.size(); ++n)
    if (settings_.faulty[n]) standings_.becomes_faulty(static_cast<NodeId>(n));
}

void FaultJudge::notice(Check check, NodeId by, TrueTime when) {
  if (when < settings_.settled && settings_.usual[static_cast<std::size_t>(check)]) return;
  const bool itself = standings_.faulty(by);
  FlexRayJudgeBase::notice(check, !itself, itself, when);
}

void FaultJudge::state_changed(NodeId node, PocKind from, PocKind to, TrueTime when) {
  // It leaves normal active, too, if it has lost its supply meanwhile and begins anew.
  if (to != PocKind::kNormalActive || from == PocKind::kDefaultConfig) left_active(node, when);
  if (to == PocKind::kNormalPassive) {
    notice(Check::kPassive, node, when);
    set_first(judgement_.passive, when);
  }
  if (to == PocKind::kHalt) {
    notice(Check::kHalt, node, when);
    set_first(judgement_.halt, when);
  }
  if (to == PocKind::kNormalActive) {
    standings_.becomes_active(node);
    came_back(node, when);
  }
}

void FaultJudge::left_active(NodeId node, TrueTime when) {
  if (!standings_.active(node)) return;
  if (standings_.counts(node)) harm(Harm::kLeftActive, when, node);
  went_out(node, when);
  standings_.leaves_active(node);
}

void FaultJudge::slot_problem(NodeId node, bus::controller::SlotStatus status, TrueTime when) {
  for_each_check(status, [&](Check check) { notice(check, node, when); });
}

void FaultJudge::clock_corrected(NodeId node, bool missing, bool limit_reached, TrueTime when) {
  if (missing) notice(Check::kMissingTerm, node, when);
  if (limit_reached) notice(Check::kLimit, node, when);
}

void FaultJudge::precision(Duration apart, TrueTime when) {
  if (apart > settings_.assumed_precision) harm(Harm::kPrecision, when, kNoNode);
}

const Judgement& FaultJudge::finish(TrueTime when) {
  ledger_.finish(when);
  for (std::size_t n = 0; n < standings_.size(); ++n)
    if (const auto node = static_cast<NodeId>(n); standings_.never_started(node)) harm(Harm::kNotStarted, when, node);
  return finished();
}

}  // namespace ttf::evaluation::faults
