#include "bus/poc/states.h"

namespace ttf::bus::poc {
namespace {

PocReason objection_to_coldstart(const PocParameters& parameters, const PocState& state) {
  if (!parameters.pKeySlotUsedForStartup) return PocReason::kNotAColdstartNode;
  if (state.vColdstartInhibit) return PocReason::kColdstartInhibited;
  if (attempts_exhausted(state)) return PocReason::kAttemptsExhausted;
  return PocReason::kMayColdstart;
}

}  // namespace

PocStep ignore(const Now& now, PocReason why) { return {now.state, {}, why, PocReason::kNone}; }

PocStep stay(const Now& now, PocReason why, PocActions actions) { return {now.state, actions, why, PocReason::kNone}; }

PocStep enter(const Now& now, PocKind kind, PocReason why, PocActions actions) {
  PocStep step = stay(now, why, actions);
  step.next.kind = kind;
  step.next.cycles = 0;
  step.next.good_double_cycles = 0;
  step.next.clock = ClockVerdict::kNone;
  return step;
}

PocStep power_on(const Now& now) { return {poc_power_on(now.parameters), {}, PocReason::kPowerOn, PocReason::kNone}; }

PocStep ready(const Now& now, PocReason why) {
  PocStep step = enter(now, PocKind::kReady, why);
  step.next.vColdstartInhibit = true;
  step.next.ready_requested = false;
  step.next.vClockCorrectionFailed = 0;
  step.next.vAllowPassiveToActive = 0;
  step.next.reference = 0;
  step.next.slot_mode = now.parameters.pKeySlotOnlyEnabled ? SlotMode::kKeySlotOnly : SlotMode::kAll;
  return step;
}

PocStep halt(const Now& now, PocReason why) {
  PocStep step = enter(now, PocKind::kHalt, why);
  step.next.halted_from = now.state.kind;
  return step;
}

PocStep freeze(const Now& now, PocReason why) {
  PocStep step = halt(now, why);
  step.next.frozen = true;
  return step;
}

PocStep allow_coldstart(const Now& now) {
  PocStep step = stay(now, PocReason::kColdstartAllowed);
  step.next.vColdstartInhibit = false;
  return step;
}

PocStep listen(const Now& now, PocReason why) {
  return listen_with(now.parameters, enter(now, PocKind::kIntegrationListen, why));
}

PocStep listen_with(const PocParameters& parameters, PocStep step) {
  step.next.reference = 0;
  step.consequence = objection_to_coldstart(parameters, step.next);
  if (step.consequence == PocReason::kMayColdstart) {
    step.next.kind = PocKind::kColdstartListen;
    step.actions |= PocActions(PocAction::kRestartListenTimer) | PocAction::kRestartNoiseTimer;
  }
  return step;
}

PocStep derive_schedule(const Now& now) {
  if (now.event.cycle % 2 != 0) return ignore(now, PocReason::kEvenFrameAwaited);
  PocStep step = enter(now, PocKind::kInitialiseSchedule, PocReason::kStartupFrameReceived, PocAction::kDeriveSchedule);
  step.next.reference = now.event.frame_id;
  return step;
}

PocStep note_clock(const Now& now) {
  PocStep step = stay(now, PocReason::kClockInOrder);
  step.next.clock = ClockVerdict::kInOrder;
  if (now.event.missing) {
    step.next.clock = ClockVerdict::kTermMissing;
    step.reason = PocReason::kClockTermMissing;
  }
  if (now.event.limit_exceeded) {
    step.next.clock = ClockVerdict::kLimitExceeded;
    step.reason = PocReason::kClockLimitExceeded;
  }
  return step;
}

PocReason clock_objection(const PocState& state) {
  switch (state.clock) {
    case ClockVerdict::kInOrder: return PocReason::kNone;
    case ClockVerdict::kNone:
    case ClockVerdict::kTermMissing: return PocReason::kStartupClockTermMissing;
    case ClockVerdict::kLimitExceeded: return PocReason::kStartupClockLimitExceeded;
  }
  return PocReason::kNone;
}

}  // namespace ttf::bus::poc
