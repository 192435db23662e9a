#include "evaluation/faults/slot_ledger.h"

#include <algorithm>
#include <limits>

#include "schedules/model/round.h"

namespace ttf::evaluation::faults {
namespace {

using schedules::model::Channel;
constexpr TrueTime kEverything{std::numeric_limits<std::int64_t>::max()};

}  // namespace

SlotLedger::SlotLedger(const schedules::model::Cluster& cluster, const Standings& standings,
                       std::function<void(const SlotLoss&)> on_loss)
    : cluster_(cluster), standings_(standings),
      on_loss_(std::move(on_loss)), slot_{cluster.flexray.gdStaticSlot * cluster.flexray.gdMacrotick_ps / 1000} {
  for (Cycle& cycle : cycles_) {
    cycle.counted.resize(cluster.nodes.size());
    cycle.slots.resize(cluster.frames.size());
    for (Slot& slot : cycle.slots)
      for (auto& channel : slot.reported) channel.resize(cluster.nodes.size());
  }
}

// Returns the cycle's page; its previous content is four cycles old, and settled.
SlotLedger::Cycle& SlotLedger::open(std::int64_t cycle) {
  const std::int64_t counter = counter_in(cluster_.flexray, cycle);
  Cycle& page = cycles_[static_cast<std::size_t>(counter) % kCycles];
  if (page.counter == counter) return page;
  // All nodes have reported the cycle before the last.
  const std::int64_t due = counter_in(cluster_.flexray, counter - 2);
  Cycle& before = cycles_[static_cast<std::size_t>(due) % kCycles];
  if (before.counter == due) settle(before, kEverything);
  before.counter = -1;
  page.counter = counter;
  newest_ = counter;
  for (std::size_t n = 0; n < page.counted.size(); ++n) page.counted[n] = standings_.counts(static_cast<NodeId>(n));
  for (Slot& slot : page.slots) {
    slot.counted = false;
    slot.sent = {};
    for (auto& channel : slot.reported) std::fill(channel.begin(), channel.end(), false);
  }
  return page;
}

void SlotLedger::finish(TrueTime at) {
  if (newest_ < 0) return;
  for (std::int64_t back = kCycles - 1; back >= 0; --back) {
    const std::int64_t counter = counter_in(cluster_.flexray, newest_ - back);
    Cycle& page = cycles_[static_cast<std::size_t>(counter) % kCycles];
    if (page.counter != counter) continue;
    settle(page, at);
    page.counter = -1;
  }
  newest_ = -1;
}

void SlotLedger::on(const recording::records::SlotFrameSent& frame) {
  if (!standings_.counts(frame.stamp.node)) return;  // a node out of operation may be in a cycle of its own
  Cycle& page = open(frame.cycle);
  for (std::size_t f = 0; f < cluster_.frames.size(); ++f) {
    const schedules::model::FrameSlot& expected = cluster_.frames[f];
    if (expected.slot != frame.slot || expected.sender != frame.stamp.node ||
        !schedules::model::in_cycle(expected, static_cast<int>(page.counter)))
      continue;
    Slot& slot = page.slots[f];
    slot.counted = true;
    slot.at = frame.stamp.true_time;
    slot.sent[frame.channel & 1u] = true;
  }
}

void SlotLedger::on(const recording::records::SlotProblem& problem) {
  if (!standings_.counts(problem.stamp.node) || problem.slot == 0 ||
      problem.slot > cluster_.flexray.gNumberOfStaticSlots)
    return;
  Cycle& page = open(problem.cycle);
  for (std::size_t f = 0; f < cluster_.frames.size(); ++f)
    if (cluster_.frames[f].slot == problem.slot &&
        schedules::model::in_cycle(cluster_.frames[f], static_cast<int>(page.counter)))
      page.slots[f].reported[problem.channel & 1u][index_of(problem.stamp.node)] = true;
}

void SlotLedger::settle(const Cycle& cycle, TrueTime over) {
  for (std::size_t f = 0; f < cluster_.frames.size(); ++f) {
    const schedules::model::FrameSlot& frame = cluster_.frames[f];
    const Slot& slot = cycle.slots[f];
    if (frame.slot > cluster_.flexray.gNumberOfStaticSlots || !slot.counted || !standings_.counts(frame.sender))
      continue;
    // From the frame to the end of the static segment: the remaining slots, and this one, which began an action
    // point offset before its frame.
    if (slot.at + slot_ * (cluster_.flexray.gNumberOfStaticSlots - frame.slot + 1) > over) continue;
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
      const auto receiver = static_cast<NodeId>(n);
      if (!cycle.counted[n] || !is_owed(frame, cluster_, standings_, receiver)) continue;
      bool received = false, forged = false;
      for (const Channel channel : schedules::model::kBothChannels) {
        if (!comes_on(frame, cluster_, receiver, channel)) continue;
        const auto c = index_of(channel);
        received = received || (slot.sent[c] && !slot.reported[c][n]);
        forged = forged || (!slot.sent[c] && !slot.reported[c][n]);
      }
      if (forged) on_loss_({slot.at, receiver, frame.sender, frame.slot, cycle.counter, true});
      if (!received) on_loss_({slot.at, receiver, frame.sender, frame.slot, cycle.counter, false});
    }
  }
}

}  // namespace ttf::evaluation::faults
