#include "evaluation/faults/judge.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::evaluation::faults {

using bus::poc::PocKind;

bool Judgement::harmed() const {
  return std::any_of(harms.begin(), harms.end(), [](const auto& one) { return one.has_value(); });
}

Judgement::Since Judgement::detected() const {
  Since first;
  for (const Since& since : seen_by_others)
    if (since && (!first || *since < *first)) first = since;
  return first;
}

FaultJudge::FaultJudge(const schedules::model::Cluster& cluster, JudgeSettings settings)
    : settings_(std::move(settings)), standings_(cluster, !settings_.starts_up), out_since_(cluster.nodes.size()),
      ledger_(cluster, standings_, [this](const SlotLoss& loss) {
        harm(loss.forged ? Harm::kFrameForged : Harm::kFrameLost, loss.at, loss.receiver, loss.sender, loss.slot);
      }) {
  TTF_CHECK(settings_.faulty.size() == standings_.size(), "{} of {} nodes", settings_.faulty.size(), standings_.size());
  for (std::size_t n = 0; n < standings_.size(); ++n)
    if (settings_.faulty[n]) standings_.becomes_faulty(static_cast<NodeId>(n));
}

void FaultJudge::notice(Check check, NodeId by, TrueTime when) {
  const auto c = static_cast<std::size_t>(check);
  if (!counts(when) || (when < settings_.settled && settings_.usual[c])) return;
  Judgement::Since& since = standings_.faulty(by) ? judgement_.seen_by_itself[c] : judgement_.seen_by_others[c];
  if (!since) since = when;
}

void FaultJudge::harm(Harm harm, TrueTime when, NodeId node, NodeId sender, int slot) {
  if (!counts(when)) return;
  auto& harmed = judgement_.harms[static_cast<std::size_t>(harm)];
  if (!harmed) harmed = Judgement::Harmed{when, node, sender, slot};
}

void FaultJudge::state_changed(NodeId node, PocKind from, PocKind to, TrueTime when) {
  // It leaves normal active, too, if it has lost its supply meanwhile and begins anew.
  if (to != PocKind::kNormalActive || from == PocKind::kDefaultConfig) left_active(node, when);
  if (to == PocKind::kNormalPassive) {
    notice(Check::kPassive, node, when);
    if (counts(when) && !judgement_.passive) judgement_.passive = when;
  }
  if (to == PocKind::kHalt) {
    notice(Check::kHalt, node, when);
    if (counts(when) && !judgement_.halt) judgement_.halt = when;
  }
  if (to == PocKind::kNormalActive) {
    standings_.becomes_active(node);
    came_back(node, when);
  }
}

void FaultJudge::left_active(NodeId node, TrueTime when) {
  if (!standings_.active(node)) return;
  if (standings_.counts(node)) harm(Harm::kLeftActive, when, node);
  if (counts(when) && !out_since_[index_of(node)]) out_since_[index_of(node)] = when;
  standings_.leaves_active(node);
}

void FaultJudge::came_back(NodeId node, TrueTime when) {
  std::optional<TrueTime>& out_since = out_since_[index_of(node)];
  if (!out_since) return;
  const TrueTime since = settings_.until <= when ? std::max(settings_.until, *out_since) : *out_since;
  judgement_.reintegration = std::max(judgement_.reintegration.value_or(Duration{}), when - since);
  out_since.reset();
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
  judgement_.still_out = 0;
  for (std::size_t n = 0; n < standings_.size(); ++n) {
    const auto node = static_cast<NodeId>(n);
    if (standings_.never_started(node)) harm(Harm::kNotStarted, when, node);
    judgement_.still_out += out_since_[n].has_value();
  }
  return judgement_;
}

}  // namespace ttf::evaluation::faults
