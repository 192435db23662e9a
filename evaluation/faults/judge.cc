#include "evaluation/faults/judge.h"

#include <algorithm>
#include <cstring>

#include "bus/controller/slot_table.h"
#include "core/check.h"
#include "schedules/model/round.h"

namespace ttf::evaluation::faults {
namespace {

using bus::poc::PocKind;
using schedules::model::Channel;

constexpr int kCyclesUntilOverdue = 2;

bool same_bytes(std::span<const std::byte> a, std::span<const std::byte> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size()) == 0);
}

}  // namespace

std::string_view name_of(Check check) {
  switch (check) {
    case Check::kSyntax: return "syntax";
    case Check::kContent: return "content";
    case Check::kBoundary: return "boundary";
    case Check::kConflict: return "conflict";
    case Check::kNoFrame: return "no_frame";
    case Check::kMissingTerm: return "missing_term";
    case Check::kLimit: return "limit";
    case Check::kPassive: return "passive";
    case Check::kHalt: return "halt";
    case Check::kGuardian: return "guardian";
  }
  TTF_CHECK(false, "check {}", static_cast<int>(check));
}

std::string_view name_of(Harm harm) {
  switch (harm) {
    case Harm::kLeftActive: return "left_active";
    case Harm::kNotStarted: return "not_started";
    case Harm::kPrecision: return "precision";
    case Harm::kFrameLost: return "frame_lost";
    case Harm::kFrameForged: return "frame_forged";
  }
  TTF_CHECK(false, "harm {}", static_cast<int>(harm));
}

std::vector<bool> named_by(const ttf::faults::Fault& fault, const schedules::model::Cluster& cluster) {
  std::vector<bool> named(cluster.nodes.size(), false);
  if (fault.node != kNoNode) named[index_of(fault.node)] = true;
  if (fault.kind != ttf::faults::FaultKind::kLoneColdstart) return named;
  for (std::size_t n = 0; n < named.size(); ++n) {
    const auto& p = cluster.nodes[n].flexray;
    if (p && (fault.all_others || p->pKeySlotUsedForStartup)) named[n] = true;
  }
  return named;
}

NodeId owner_of(const schedules::model::Cluster& cluster, int slot, Channel channel, std::int64_t cycle) {
  const auto counter = static_cast<int>(cycle & (schedules::model::kCycles - 1));
  for (const schedules::model::FrameSlot& frame : cluster.frames)
    if (frame.slot == slot && includes(frame.channels, channel) && schedules::model::in_cycle(frame, counter))
      return frame.sender;
  return kNoNode;
}

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
    : cluster_(cluster), settings_(std::move(settings)), nodes_(cluster.nodes.size()) {
  TTF_CHECK(settings_.faulty.size() == nodes_.size(), "{} of {} nodes", settings_.faulty.size(), nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    nodes_[n].faulty = settings_.faulty[n];
    if (cluster.nodes[n].flexray) nodes_[n].channels = cluster.nodes[n].flexray->pChannels;
  }
  int slots = 0;
  for (const schedules::model::FrameSlot& frame : cluster.frames) slots = std::max(slots, frame.slot);
  owed_.resize(static_cast<std::size_t>(slots) + 1);
  for (Owed& owed : owed_) owed.receivers.resize(nodes_.size(), false);
}

bool FaultJudge::Sent::says(const bus::wire::DecodedFrame& frame) const {
  const bus::wire::FrameHeader& other = frame.header;
  return any && other.frame_id == header.frame_id && other.cycle == header.cycle &&
         other.payload_preamble == header.payload_preamble && other.null_frame == header.null_frame &&
         other.sync == header.sync && other.startup == header.startup && same_bytes(payload(), frame.payload);
}

void FaultJudge::notice(Check check, NodeId by, TrueTime when) {
  const auto c = static_cast<std::size_t>(check);
  if (!counts(when) || (when < settings_.settled && settings_.usual[c])) return;
  Judgement::Since& since = faulty(by) ? judgement_.seen_by_itself[c] : judgement_.seen_by_others[c];
  if (!since) since = when;
}

void FaultJudge::harm(Harm harm, TrueTime when, NodeId node, NodeId sender, int slot) {
  if (!counts(when)) return;
  auto& harmed = judgement_.harms[static_cast<std::size_t>(harm)];
  if (!harmed) harmed = Judgement::Harmed{when, node, sender, slot};
}

void FaultJudge::state_changed(NodeId id, PocKind from, PocKind to, TrueTime when) {
  Node& node = nodes_[index_of(id)];
  if (from == PocKind::kDefaultConfig && node.state == PocKind::kNormalActive) lost_supply(id, when);
  if (node.state == PocKind::kNormalActive && to != PocKind::kNormalActive) {
    if (!node.faulty) harm(Harm::kLeftActive, when, id);
    if (counts(when) && !node.out_since) node.out_since = when;
  }
  node.state = to;
  if (to == PocKind::kNormalPassive) {
    notice(Check::kPassive, id, when);
    if (counts(when) && !judgement_.passive) judgement_.passive = when;
  }
  if (to == PocKind::kHalt) {
    notice(Check::kHalt, id, when);
    if (counts(when) && !judgement_.halt) judgement_.halt = when;
  }
  if (to == PocKind::kNormalActive) {
    node.was_active = true;
    came_back(node, when);
  }
}

void FaultJudge::lost_supply(NodeId id, TrueTime when) {
  Node& node = nodes_[index_of(id)];
  if (node.state == PocKind::kNormalActive) {
    if (!node.faulty) harm(Harm::kLeftActive, when, id);
    if (counts(when) && !node.out_since) node.out_since = when;
  }
  node.state = PocKind::kDefaultConfig;
}

void FaultJudge::came_back(Node& node, TrueTime when) {
  if (!node.out_since) return;
  const TrueTime since = settings_.until <= when ? std::max(settings_.until, *node.out_since) : *node.out_since;
  judgement_.reintegration = std::max(judgement_.reintegration.value_or(Duration{}), when - since);
  node.out_since.reset();
}

void FaultJudge::slot_problem(NodeId node, bus::controller::SlotStatus status, TrueTime when) {
  const auto bits = static_cast<unsigned>(status);
  if ((bits & bus::controller::kSyntaxError) != 0) notice(Check::kSyntax, node, when);
  if ((bits & bus::controller::kContentError) != 0) notice(Check::kContent, node, when);
  if ((bits & bus::controller::kBoundaryViolation) != 0) notice(Check::kBoundary, node, when);
  if ((bits & bus::controller::kTransmissionConflict) != 0) notice(Check::kConflict, node, when);
  if ((bits & bus::controller::kNoFrame) != 0) notice(Check::kNoFrame, node, when);
}

void FaultJudge::clock_corrected(NodeId node, bool missing, bool limit_reached, TrueTime when) {
  if (missing) notice(Check::kMissingTerm, node, when);
  if (limit_reached) notice(Check::kLimit, node, when);
}

// Who has not received it by now never will.
void FaultJudge::collect(Owed& owed, int slot) {
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (owed.receivers[n]) harm(Harm::kFrameLost, owed.sent, static_cast<NodeId>(n), owed.sender, slot);
    owed.receivers[n] = false;
  }
}

void FaultJudge::frame_sent(NodeId id, int slot, Channel channel, const bus::wire::DecodedFrame& frame, TrueTime when) {
  const Node& sender = nodes_[index_of(id)];
  if (sender.faulty || slot < 0 || static_cast<std::size_t>(slot) >= owed_.size()) return;
  Owed& owed = owed_[static_cast<std::size_t>(slot)];
  // The other channel's copy: at the same instant in the static segment, maybe a cycle later in the dynamic one.
  const Sent& other = owed.as_sent[1 - index_of(channel)];
  const bool same_content = other.any && same_bytes(other.payload(), frame.payload);
  const bool dynamic = slot > cluster_.flexray.gNumberOfStaticSlots;
  const bool copy =
      owed.sender == id &&
      (dynamic ? same_content && when - owed.sent <= cluster_.cycle() * kCyclesUntilOverdue : owed.sent == when);
  if (!copy) {
    collect(owed, slot);
    owed.sender = id;
    owed.sent = when;
    for (const schedules::model::FrameSlot& own : cluster_.frames) {
      if (own.slot != slot || own.sender != id || sender.state != PocKind::kNormalActive) continue;
      for (std::size_t n = 0; n < nodes_.size(); ++n) {
        const Node& node = nodes_[n];
        const bool shares = std::any_of(
            schedules::model::kBothChannels.begin(), schedules::model::kBothChannels.end(), [&](Channel one) {
              return includes(own.channels, one) && includes(sender.channels, one) && includes(node.channels, one);
            });
        if (static_cast<NodeId>(n) != id && !node.faulty && node.state == PocKind::kNormalActive && shares)
          owed.receivers[n] = true;
      }
    }
  }
  Sent& sent = owed.as_sent[index_of(channel)];
  sent.any = true;
  sent.at = when;
  sent.header = frame.header;
  std::ranges::copy(frame.payload, sent.bytes.begin());
  sent.size = frame.payload.size();
}

void FaultJudge::frame_received(NodeId id, int slot, Channel channel, const bus::wire::DecodedFrame& frame,
                                TrueTime when) {
  if (faulty(id) || slot < 0 || static_cast<std::size_t>(slot) >= owed_.size()) return;
  const NodeId sender = owner_of(cluster_, slot, channel, frame.header.cycle);
  if (sender == kNoNode || faulty(sender) || sender == id) return;
  Owed& owed = owed_[static_cast<std::size_t>(slot)];
  const Sent& sent = owed.as_sent[index_of(channel)];
  if (owed.sender == sender && when - sent.at < cluster_.cycle() && sent.says(frame))
    owed.receivers[index_of(id)] = false;
  else
    harm(Harm::kFrameForged, when, id, sender, slot);
}

void FaultJudge::precision(Duration apart, TrueTime when) {
  if (apart > settings_.assumed_precision) harm(Harm::kPrecision, when, kNoNode);
}

bool FaultJudge::all_fault_free_active() const {
  return std::all_of(nodes_.begin(), nodes_.end(),
                     [](const Node& node) { return node.faulty || node.state == PocKind::kNormalActive; });
}

const Judgement& FaultJudge::finish(TrueTime when) {
  for (std::size_t slot = 0; slot < owed_.size(); ++slot)
    if (owed_[slot].sender != kNoNode && owed_[slot].sent + cluster_.cycle() * kCyclesUntilOverdue <= when)
      collect(owed_[slot], static_cast<int>(slot));
  judgement_.still_out = 0;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (settings_.starts_up && !nodes_[n].faulty && !nodes_[n].was_active)
      harm(Harm::kNotStarted, when, static_cast<NodeId>(n));
    judgement_.still_out += nodes_[n].out_since.has_value();
  }
  return judgement_;
}

}  // namespace ttf::evaluation::faults
