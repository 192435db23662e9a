#include "bus/guardian/startup_turns.h"

#include <algorithm>

namespace ttf::bus::guardian {

StartupTurns::StartupTurns(const schedules::model::Cluster& cluster, schedules::model::Channel channel,
                           const schedules::model::NodeParameters& clock)
    : cluster_(cluster), channel_(channel),
      lengths_(cluster.flexray, clock.pdMicrotick_ps), cycle_{clock.pMicroPerCycle},
      slack_(Microticks{2 * clock.pMicroPerCycle * kDriftOfAPair_ppm / 1'000'000} +
             lengths_.time(cluster.flexray.gdActionPointOffset * cluster.flexray.gdMacrotick_ps)),
      may_lead_(cluster.nodes.size()), may_wake_(cluster.nodes.size()) {}

void StartupTurns::reset() {
  leader_ = kNoNode;
  std::fill(may_lead_.begin(), may_lead_.end(), Microticks{});
  std::fill(may_wake_.begin(), may_wake_.end(), Microticks{});
}

// A lead whose time ends without a schedule has failed at that end, whenever it is asked about.
Microticks StartupTurns::waits_until(NodeId node, Microticks at) const {
  if (node == leader_ && at >= lead_end_) return lead_end_ + cycles(kWaitCycles);
  return may_lead_[index_of(node)];
}

GuardianAnswer StartupTurns::judge(const GuardianSignal& signal) const {
  const schedules::model::NodeParameters& p = *cluster_.node(signal.branch).flexray;
  const Microticks at = signal.start;
  const bool leading = leads(at) && signal.branch == leader_;
  switch (signal.signal) {
    case ports::Signal::kUndecodable: return GuardianAnswer::no(GuardianReason::kUndecodable);
    case ports::Signal::kWakeup:
      if (p.pWakeupChannel != channel_ || at < may_wake_[index_of(signal.branch)])
        return GuardianAnswer::no(GuardianReason::kNoWakeup);
      if (leads(at)) return GuardianAnswer::no(GuardianReason::kOtherLeads);
      return {GuardianReason::kForwarded, at + lengths_.wakeup_pattern(p.pWakeupPattern)};
    case ports::Signal::kCas:
      if (!p.pKeySlotUsedForStartup) return GuardianAnswer::no(GuardianReason::kNoColdstartNode);
      if (leading) return GuardianAnswer::no(GuardianReason::kTooSoon);
      break;
    case ports::Signal::kFrame: {
      if (!wire::has_header(*signal.frame)) return GuardianAnswer::no(GuardianReason::kUndecodable);
      if (!p.pKeySlotUsedForStartup) return GuardianAnswer::no(GuardianReason::kNoColdstartNode);
      const wire::FrameHeader& header = signal.frame->header;
      if (!header.startup || !header.sync || header.frame_id != p.pKeySlotId ||
          header.payload_words != cluster_.flexray.gPayloadLengthStatic)
        return GuardianAnswer::no(GuardianReason::kNoStartupFrame);
      if (leading && at < next_frame_) return GuardianAnswer::no(GuardianReason::kTooSoon);
      break;
    }
  }
  if (!leading && leads(at)) return GuardianAnswer::no(GuardianReason::kOtherLeads);
  if (!leading && at < waits_until(signal.branch, at)) return GuardianAnswer::no(GuardianReason::kLeadFailed);
  return {GuardianReason::kForwarded,
          at + (signal.signal == ports::Signal::kCas ? lengths_.symbol()
                                                     : lengths_.frame(cluster_.flexray.gPayloadLengthStatic))};
}

bool StartupTurns::forwarded(const GuardianSignal& signal, bool has_schedule) {
  if (signal.signal == ports::Signal::kWakeup) {
    may_wake_[index_of(signal.branch)] = signal.start + cycles(kWaitCycles);
    return false;
  }
  const bool begins = !has_schedule && !leads(signal.start);
  if (begins) {
    if (leader_ != kNoNode) may_lead_[index_of(leader_)] = lead_end_ + cycles(kWaitCycles);
    leader_ = signal.branch;
    lead_begin_ = signal.start;
    frames_ = signal.signal == ports::Signal::kCas ? 0 : kOutOfOrder;
  }
  if (signal.signal == ports::Signal::kFrame && signal.branch == leader_) count_frame(signal.frame->header);
  if (has_schedule) return false;
  next_frame_ = signal.signal == ports::Signal::kFrame ? signal.start + cycle_ - slack_ : signal.start;
  // After the symbol, the frame of cycle 0 comes within the static segment.
  const Microticks silence =
      cycle_ + slack_ + (signal.signal == ports::Signal::kCas ? lengths_.symbol() : Microticks{});
  lead_end_ = std::min(signal.start + silence, lead_begin_ + cycles(kLeadCycles));
  return begins;
}

void StartupTurns::count_frame(const wire::FrameHeader& header) {
  if (header.startup && frames_ != kOutOfOrder) frames_ = header.cycle == frames_ ? frames_ + 1 : kOutOfOrder;
}

void StartupTurns::schedule_dropped(Microticks at) {
  if (leader_ == kNoNode) return;
  // The drop comes with the end of cycle 4.
  const bool as_it_should = frames_ == kFramesOfALead;
  may_lead_[index_of(leader_)] = at + (as_it_should ? cycle_ - slack_ : cycles(kWaitCycles));
  leader_ = kNoNode;
}

void StartupTurns::synchronised() { leader_ = kNoNode; }

}  // namespace ttf::bus::guardian
