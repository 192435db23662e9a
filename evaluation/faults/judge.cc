#include "evaluation/faults/judge.h"

#include <utility>

#include "core/check.h"

namespace ttf::evaluation::faults {

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
  if (check == Check::kPassive) set_first(judgement_.passive, when);
  if (check == Check::kHalt) set_first(judgement_.halt, when);
  if (when < settings_.settled && settings_.usual[static_cast<std::size_t>(check)]) return;
  const bool itself = standings_.faulty(by);
  FlexRayJudgeBase::notice(check, !itself, itself, when);
}

void FaultJudge::on(const recording::records::StateChanged& change) {
  notice(change);
  if (standings_.leaves_by(change)) left_active(change.stamp.node, change.stamp.true_time);
  if (standings_.active(change.stamp.node)) came_back(change.stamp.node, change.stamp.true_time);
}

void FaultJudge::on(const recording::records::PowerChanged& power) {
  if (standings_.leaves_by(power)) left_active(power.stamp.node, power.stamp.true_time);
}

void FaultJudge::left_active(NodeId node, TrueTime when) {
  if (!standings_.faulty(node)) harm(Harm::kLeftActive, when, node);
  went_out(node, when);
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
