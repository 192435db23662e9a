#include "evaluation/faults/frame_ledger.h"

#include <algorithm>
#include <cstring>

namespace ttf::evaluation::faults {
namespace {

using schedules::model::Channel;

constexpr int kCyclesUntilOverdue = 2;

bool same_bytes(std::span<const std::byte> a, std::span<const std::byte> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size()) == 0);
}

}  // namespace

FrameLedger::FrameLedger(const schedules::model::Cluster& cluster, const Standings& standings,
                         std::function<void(const SlotLoss&)> on_loss)
    : cluster_(cluster), standings_(standings), on_loss_(std::move(on_loss)) {
  int slots = 0;
  for (const schedules::model::FrameSlot& frame : cluster.frames) slots = std::max(slots, frame.slot);
  owed_.resize(static_cast<std::size_t>(slots) + 1);
  for (Owed& owed : owed_) owed.receivers.resize(standings.size(), false);
}

bool FrameLedger::Sent::says(const bus::wire::DecodedFrame& frame) const {
  const bus::wire::FrameHeader& other = frame.header;
  return any && other.frame_id == header.frame_id && other.cycle == header.cycle &&
         other.payload_preamble == header.payload_preamble && other.null_frame == header.null_frame &&
         other.sync == header.sync && other.startup == header.startup && same_bytes(payload(), frame.payload);
}

// Returns whether the frame is the other channel's copy: at the same instant in the static segment, perhaps a
// cycle later in the dynamic one.
bool FrameLedger::is_copy(const Owed& owed, NodeId node, int slot, Channel channel,
                          const bus::wire::DecodedFrame& frame, TrueTime at) const {
  if (owed.sender != node) return false;
  if (slot <= cluster_.flexray.gNumberOfStaticSlots) return owed.sent == at;
  const Sent& other = owed.as_sent[1 - index_of(channel)];
  return other.any && same_bytes(other.payload(), frame.payload) &&
         at - owed.sent <= cluster_.cycle() * kCyclesUntilOverdue;
}

void FrameLedger::owe(Owed& owed, NodeId sender, int slot) {
  if (!standings_.active(sender)) return;
  for (const schedules::model::FrameSlot& own : cluster_.frames) {
    if (own.slot != slot || own.sender != sender) continue;
    for (std::size_t n = 0; n < standings_.size(); ++n)
      if (is_owed(own, cluster_, standings_, static_cast<NodeId>(n))) owed.receivers[n] = true;
  }
}

// Reports every receiver that has not received the frame by now as a loss.
void FrameLedger::collect(Owed& owed, int slot) {
  for (std::size_t n = 0; n < standings_.size(); ++n) {
    if (owed.receivers[n]) on_loss_({owed.sent, static_cast<NodeId>(n), owed.sender, slot, owed.cycle, false});
    owed.receivers[n] = false;
  }
}

void FrameLedger::sent(NodeId node, int slot, Channel channel, const bus::wire::DecodedFrame& frame, TrueTime at) {
  if (standings_.faulty(node) || !has(slot)) return;
  Owed& owed = owed_[static_cast<std::size_t>(slot)];
  if (!is_copy(owed, node, slot, channel, frame, at)) {
    collect(owed, slot);
    owed.sender = node;
    owed.sent = at;
    owed.cycle = frame.header.cycle;
    owe(owed, node, slot);
  }
  Sent& sent = owed.as_sent[index_of(channel)];
  sent.any = true;
  sent.at = at;
  sent.header = frame.header;
  std::ranges::copy(frame.payload, sent.bytes.begin());
  sent.size = frame.payload.size();
}

void FrameLedger::received(NodeId node, int slot, Channel channel, const bus::wire::DecodedFrame& frame, TrueTime at) {
  if (standings_.faulty(node) || !has(slot)) return;
  const NodeId sender = owner_of(cluster_, slot, channel, frame.header.cycle);
  if (sender == kNoNode || standings_.faulty(sender) || sender == node) return;
  Owed& owed = owed_[static_cast<std::size_t>(slot)];
  const Sent& sent = owed.as_sent[index_of(channel)];
  if (owed.sender == sender && at - sent.at < cluster_.cycle() && sent.says(frame))
    owed.receivers[index_of(node)] = false;
  else
    on_loss_({at, node, sender, slot, frame.header.cycle, true});
}

void FrameLedger::finish(TrueTime at) {
  for (std::size_t slot = 0; slot < owed_.size(); ++slot)
    if (owed_[slot].sender != kNoNode && owed_[slot].sent + cluster_.cycle() * kCyclesUntilOverdue <= at)
      collect(owed_[slot], static_cast<int>(slot));
}

}  // namespace ttf::evaluation::faults
