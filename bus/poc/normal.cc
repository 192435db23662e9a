// Normal operation and its degradation (SPNU563A 26.2.5, 26.2.6.8, 26.2.6.9).
#include <algorithm>

#include "bus/poc/states.h"

namespace ttf::bus::poc {
namespace {

// The step of both states at the start of a cycle, before each judges the clock.
PocStep next_cycle(const Now& now, PocReason why) {
  PocStep step = stay(now, why);
  step.next.clock = ClockVerdict::kNone;
  if (step.next.slot_mode == SlotMode::kAllPending) step.next.slot_mode = SlotMode::kAll;
  return step;
}

PocStep become(PocStep step, PocKind kind, PocReason why) {
  step.next.kind = kind;
  step.next.vAllowPassiveToActive = 0;
  step.reason = why;
  return step;
}

}  // namespace

PocStep request_halt(const Now& now) {
  PocStep step = stay(now, PocReason::kHaltRequested);
  step.next.halt_requested = true;
  return step;
}

PocStep request_ready(const Now& now) {
  PocStep step = stay(now, PocReason::kReadyRequested);
  step.next.ready_requested = true;
  return step;
}

PocStep request_all_slots(const Now& now) {
  if (now.state.slot_mode != SlotMode::kKeySlotOnly) return ignore(now, PocReason::kCommandNotAccepted);
  PocStep step = stay(now, PocReason::kAllSlotsRequested);
  step.next.slot_mode = SlotMode::kAllPending;
  return step;
}

// vClockCorrectionFailed counts consecutive odd cycles without a term.
PocStep count_clock(const Now& now) {
  PocStep step = note_clock(now);
  step.next.vClockCorrectionFailed =
      now.event.missing ? std::min(now.state.vClockCorrectionFailed + 1, kMaxClockCorrectionFailed) : 0;
  return step;
}

PocStep active_cycle(const Now& now) {
  if (now.state.halt_requested) return halt(now, PocReason::kHaltAtCycleEnd);
  if (now.state.ready_requested) return ready(now, PocReason::kReadyAtCycleEnd);
  const PocStep step = next_cycle(now, PocReason::kCycleGoesOn);
  const PocParameters& p = now.parameters;
  switch (now.state.clock) {
    case ClockVerdict::kNone:
    case ClockVerdict::kInOrder: return step;
    case ClockVerdict::kTermMissing:
      if (now.state.vClockCorrectionFailed >= p.gMaxWithoutClockCorrectionFatal && p.pAllowHaltDueToClock)
        return halt(now, PocReason::kHaltByMissingTerms);
      if (now.state.vClockCorrectionFailed >= p.gMaxWithoutClockCorrectionPassive)
        return become(step, PocKind::kNormalPassive, PocReason::kPassiveByMissingTerms);
      return step;
    case ClockVerdict::kLimitExceeded:
      if (p.pAllowHaltDueToClock) return halt(now, PocReason::kHaltByLimit);
      return become(step, PocKind::kNormalPassive, PocReason::kPassiveByLimit);
  }
  return step;
}

PocStep passive_cycle(const Now& now) {
  if (now.state.halt_requested) return halt(now, PocReason::kHaltAtCycleEnd);
  if (now.state.ready_requested) return ready(now, PocReason::kReadyAtCycleEnd);
  PocStep step = next_cycle(now, PocReason::kStaysPassive);
  const PocParameters& p = now.parameters;
  switch (now.state.clock) {
    case ClockVerdict::kNone: return step;  // an even cycle has ended
    case ClockVerdict::kInOrder:
      if (p.pAllowPassiveToActive == 0) return step;  // never
      if (++step.next.vAllowPassiveToActive < p.pAllowPassiveToActive) return step;
      return become(step, PocKind::kNormalActive, PocReason::kBackToActive);
    case ClockVerdict::kTermMissing:
      if (now.state.vClockCorrectionFailed >= p.gMaxWithoutClockCorrectionFatal && p.pAllowHaltDueToClock)
        return halt(now, PocReason::kHaltByMissingTerms);
      step.next.vAllowPassiveToActive = 0;
      return step;
    case ClockVerdict::kLimitExceeded:
      if (p.pAllowHaltDueToClock) return halt(now, PocReason::kHaltByLimit);
      step.next.vAllowPassiveToActive = 0;
      return step;
  }
  return step;
}

}  // namespace ttf::bus::poc
