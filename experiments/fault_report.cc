#include "experiments/fault_report.h"

#include <algorithm>

#include "bus/controller.h"
#include "bus/poc.h"
#include "schedules/checker.h"

namespace ttf::experiments {

bool FaultSeen::harmed() const {
  return std::any_of(harms.begin(), harms.end(), [](const auto& harm) { return harm.has_value(); });
}

FaultReport::FaultReport(const schedules::Cluster& cluster, bool begins_integrated)
    : cycle_(cluster.cycle()),
      assumed_precision_{(schedules::assumed_precision_ps(cluster.flexray) + 999) / 1000},
      nodes_(cluster.nodes.size()),
      clocks_(cluster),
      ledger_(
          cluster, [this](NodeId node) { return counts(node); },
          [this](const SlotLoss& loss) {
            harm(loss.forged ? Harm::kFrameForged : Harm::kFrameLost, loss.at, loss.receiver, loss.sender, loss.slot);
          }) {
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    (begins_integrated ? nodes_[n].active : nodes_[n].has_to_start) = cluster.nodes[n].flexray.has_value();
}

void FaultReport::finish(TrueTime at) {
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    if (nodes_[n].has_to_start && !nodes_[n].faulty) harm(Harm::kNotStarted, at, static_cast<NodeId>(n));
}

bool FaultReport::harmed() const {
  return std::any_of(faults_.begin(), faults_.end(), [](const FaultSeen& fault) { return fault.harmed(); });
}

void FaultReport::on(const records::FaultActivity& activity) {
  auto known = std::find_if(faults_.begin(), faults_.end(),
                            [&](const FaultSeen& fault) { return fault.fault == activity.fault; });
  if (known == faults_.end()) {
    faults_.emplace_back();
    counted_.emplace_back();
    known = std::prev(faults_.end());
    known->fault = activity.fault;
    known->kind = activity.kind;
    known->node = activity.node;
    known->begins = activity.at;
    if (activity.node != kNoNode && index_of(activity.node) < nodes_.size()) {
      nodes_[index_of(activity.node)].faulty = true;
      clocks_.forget(activity.node);
    }
  }
  switch (activity.what) {
    case records::kFaultActs:
      ++known->acts;
      if (!known->first_act) {
        known->first_act = activity.at;
        known->text = activity.text;
      }
      break;
    case records::kFaultEnds: known->ends = activity.at; return;
    default: break;
  }
  latest_ = static_cast<std::size_t>(known - faults_.begin());
}

void FaultReport::on(const records::StateChanged& change) {
  constexpr auto kActive = static_cast<std::uint8_t>(bus::PocKind::kNormalActive);
  const NodeId node = change.stamp.node;
  const TrueTime at = change.stamp.true_time;
  if (index_of(node) >= nodes_.size()) return;
  changed(node, change.from_name, change.to_name, change.why, at);
  const std::int64_t cycle = (at - TrueTime{}).ns / cycle_.ns;
  if (change.to == static_cast<std::uint8_t>(bus::PocKind::kNormalPassive)) notice(Check::kPassive, node, cycle, at);
  if (change.to == static_cast<std::uint8_t>(bus::PocKind::kHalt)) notice(Check::kHalt, node, cycle, at);
  if (change.to != kActive) left_active(node, at);
  nodes_[index_of(node)].active = change.to == kActive;
  if (change.to == kActive) nodes_[index_of(node)].has_to_start = false;
}

void FaultReport::on(const records::PowerChanged& power) {
  const NodeId node = power.stamp.node;
  if (index_of(node) >= nodes_.size()) return;
  const std::string_view off = "without supply", on = "with supply";
  changed(node, power.on ? off : on, power.on ? on : off, "", power.stamp.true_time);
  if (power.on) return;
  left_active(node, power.stamp.true_time);
  nodes_[index_of(node)].active = false;
}

void FaultReport::left_active(NodeId node, TrueTime at) {
  clocks_.forget(node);
  if (counts(node)) harm(Harm::kLeftActive, at, node);
}

void FaultReport::on(const records::SlotProblem& problem) {
  if (index_of(problem.stamp.node) >= nodes_.size()) return;
  const auto seen = [&](bus::SlotStatus bit, Check check) {
    if ((problem.status & bit) != 0) notice(check, problem.stamp.node, problem.cycle, problem.stamp.true_time);
  };
  seen(bus::kSyntaxError, Check::kSyntax);
  seen(bus::kContentError, Check::kContent);
  seen(bus::kBoundaryViolation, Check::kBoundary);
  seen(bus::kTransmissionConflict, Check::kConflict);
  seen(bus::kNoFrame, Check::kNoFrame);
  ledger_.on(problem);
}

void FaultReport::on(const records::ClockCorrected& corrected) {
  if (index_of(corrected.stamp.node) >= nodes_.size()) return;
  const auto seen = [&](bool yes, Check check) {
    if (yes) notice(check, corrected.stamp.node, corrected.cycle, corrected.stamp.true_time);
  };
  seen(corrected.offset_missing || corrected.rate_missing, Check::kMissingTerm);
  seen(corrected.offset_limited || corrected.rate_limited, Check::kLimit);
}

void FaultReport::on(const records::SlotFrameSent& frame) {
  if (index_of(frame.stamp.node) >= nodes_.size()) return;
  ledger_.on(frame);
  if (!counts(frame.stamp.node)) return;
  const auto apart = clocks_.sent(frame);
  if (apart && *apart > assumed_precision_) harm(Harm::kPrecision, frame.stamp.true_time, kNoNode);
}

void FaultReport::notice(Check check, NodeId node, std::int64_t cycle, TrueTime at) {
  FaultSeen* fault = latest();
  if (fault == nullptr) return;
  const bool faulty = nodes_[index_of(node)].faulty;
  const auto c = static_cast<std::size_t>(check);
  CheckSeen& seen = (faulty ? fault->by_faulty : fault->by_others)[c];
  if (seen.nodes.empty()) seen.first = at;
  if (std::find(seen.nodes.begin(), seen.nodes.end(), node) == seen.nodes.end()) seen.nodes.push_back(node);
  auto& counted = counted_[*latest_][2 * c + (faulty ? 1 : 0)][static_cast<std::size_t>(cycle & 63)];
  if (!counted || at - *counted > cycle_ * 32) ++seen.cycles;
  counted = at;
}

void FaultReport::changed(NodeId node, std::string_view from, std::string_view to, std::string_view why, TrueTime at) {
  FaultSeen* fault = latest();
  if (fault == nullptr) return;
  const auto known = std::find_if(fault->states.begin(), fault->states.end(), [&](const StateSeen& state) {
    return state.node == node && state.from == from && state.to == to;
  });
  if (known != fault->states.end())
    ++known->times;
  else
    fault->states.push_back({node, std::string(from), std::string(to), std::string(why), at, 1});
}

void FaultReport::harm(Harm harm, TrueTime at, NodeId node, NodeId sender, int slot) {
  FaultSeen* fault = latest();
  if (fault == nullptr) return;
  auto& first = fault->harms[static_cast<std::size_t>(harm)];
  if (!first && at >= fault->begins) first = Judgement::Harmed{at, node, sender, slot};
}

}  // namespace ttf::experiments
