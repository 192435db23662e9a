// The states in which the controller is deaf and does what its host says.
#include "bus/poc_states.h"

namespace ttf::bus::poc {

PocStep in_default_config(const Now& now) {
  switch (now.event.kind) {
    case PocEventKind::kPowerOn: return power_on(now);
    case PocEventKind::kFreeze: return freeze(now, PocReason::kFreezeCommand);
    case PocEventKind::kFatalError: return freeze(now, PocReason::kFatalError);
    case PocEventKind::kConfig: return enter(now, PocKind::kConfig, PocReason::kConfigCommand);
    case PocEventKind::kConfigComplete:
    case PocEventKind::kReady:
    case PocEventKind::kRun:
    case PocEventKind::kAllowColdstart:
    case PocEventKind::kWakeup:
    case PocEventKind::kAllSlots:
    case PocEventKind::kHalt: return ignore(now, PocReason::kCommandNotAccepted);
    case PocEventKind::kChannelActive:
    case PocEventKind::kChannelsIdle:
    case PocEventKind::kCasReceived:
    case PocEventKind::kWakeupPatternReceived:
    case PocEventKind::kHeaderReceived:
    case PocEventKind::kStartupFrame: return ignore(now, PocReason::kReceiverOff);
    case PocEventKind::kListenTimeout:
    case PocEventKind::kNoiseTimeout: return ignore(now, PocReason::kNoTimerRunning);
    case PocEventKind::kWakeupSent:
    case PocEventKind::kWakeupCollision: return ignore(now, PocReason::kNotSendingWakeup);
    case PocEventKind::kScheduleNotDerived: return ignore(now, PocReason::kNotDerivingSchedule);
    case PocEventKind::kClockCorrected:
    case PocEventKind::kCycleStarted: return ignore(now, PocReason::kNoSchedule);
  }
  return unlisted(now);
}

PocStep in_config(const Now& now) {
  switch (now.event.kind) {
    case PocEventKind::kPowerOn: return power_on(now);
    case PocEventKind::kFreeze: return freeze(now, PocReason::kFreezeCommand);
    case PocEventKind::kFatalError: return freeze(now, PocReason::kFatalError);
    case PocEventKind::kConfigComplete: return ready(now, PocReason::kConfigured);
    case PocEventKind::kConfig:
    case PocEventKind::kReady:
    case PocEventKind::kRun:
    case PocEventKind::kAllowColdstart:
    case PocEventKind::kWakeup:
    case PocEventKind::kAllSlots:
    case PocEventKind::kHalt: return ignore(now, PocReason::kCommandNotAccepted);
    case PocEventKind::kChannelActive:
    case PocEventKind::kChannelsIdle:
    case PocEventKind::kCasReceived:
    case PocEventKind::kWakeupPatternReceived:
    case PocEventKind::kHeaderReceived:
    case PocEventKind::kStartupFrame: return ignore(now, PocReason::kReceiverOff);
    case PocEventKind::kListenTimeout:
    case PocEventKind::kNoiseTimeout: return ignore(now, PocReason::kNoTimerRunning);
    case PocEventKind::kWakeupSent:
    case PocEventKind::kWakeupCollision: return ignore(now, PocReason::kNotSendingWakeup);
    case PocEventKind::kScheduleNotDerived: return ignore(now, PocReason::kNotDerivingSchedule);
    case PocEventKind::kClockCorrected:
    case PocEventKind::kCycleStarted: return ignore(now, PocReason::kNoSchedule);
  }
  return unlisted(now);
}

namespace {

PocStep configure_again(const Now& now) {
  PocStep step = enter(now, PocKind::kConfig, PocReason::kConfigCommand);
  step.next.vRemainingColdstartAttempts = now.parameters.gColdStartAttempts;
  return step;
}

PocStep run(const Now& now) {
  PocStep step = enter(now, PocKind::kIntegrationListen, PocReason::kRunCommand);
  step.next.vRemainingColdstartAttempts = now.parameters.gColdStartAttempts;
  step.next.coldstart_noise = false;
  return listen_with(now.parameters, step);
}

PocStep wake(const Now& now) {
  PocStep step = enter(now, PocKind::kWakeupListen, PocReason::kWakeupCommand,
                       PocActions(PocAction::kRestartListenTimer) | PocAction::kRestartNoiseTimer);
  step.next.wakeup_status = WakeupStatus::kUndefined;
  return step;
}

}  // namespace

PocStep in_ready(const Now& now) {
  switch (now.event.kind) {
    case PocEventKind::kPowerOn: return power_on(now);
    case PocEventKind::kFreeze: return freeze(now, PocReason::kFreezeCommand);
    case PocEventKind::kFatalError: return freeze(now, PocReason::kFatalError);
    case PocEventKind::kConfig: return configure_again(now);
    case PocEventKind::kRun: return run(now);
    case PocEventKind::kWakeup: return wake(now);
    case PocEventKind::kAllowColdstart: return allow_coldstart(now);
    case PocEventKind::kConfigComplete:
    case PocEventKind::kReady:
    case PocEventKind::kAllSlots:
    case PocEventKind::kHalt: return ignore(now, PocReason::kCommandNotAccepted);
    case PocEventKind::kChannelActive:
    case PocEventKind::kChannelsIdle:
    case PocEventKind::kCasReceived:
    case PocEventKind::kWakeupPatternReceived:
    case PocEventKind::kHeaderReceived:
    case PocEventKind::kStartupFrame: return ignore(now, PocReason::kReceiverOff);
    case PocEventKind::kListenTimeout:
    case PocEventKind::kNoiseTimeout: return ignore(now, PocReason::kNoTimerRunning);
    case PocEventKind::kWakeupSent:
    case PocEventKind::kWakeupCollision: return ignore(now, PocReason::kNotSendingWakeup);
    case PocEventKind::kScheduleNotDerived: return ignore(now, PocReason::kNotDerivingSchedule);
    case PocEventKind::kClockCorrected:
    case PocEventKind::kCycleStarted: return ignore(now, PocReason::kNoSchedule);
  }
  return unlisted(now);
}

namespace {

// Everything but how the node came here is forgotten with the way out: E-Ray resets FSI, HRQ, PSL and the slot mode.
PocStep leave_halt(const Now& now) {
  return {poc_power_on(now.parameters), {}, PocReason::kLeftHalt, PocReason::kNone};
}

// A node halted otherwise is marked as frozen after all; where it came from then was halt (E-Ray CCSV.PSL).
PocStep freeze_halted(const Now& now, PocReason why) {
  if (now.state.frozen) return ignore(now, PocReason::kAlreadyFrozen);
  return freeze(now, why);
}

}  // namespace

PocStep in_halt(const Now& now) {
  switch (now.event.kind) {
    case PocEventKind::kPowerOn: return power_on(now);
    case PocEventKind::kConfig: return leave_halt(now);
    case PocEventKind::kFreeze: return freeze_halted(now, PocReason::kFreezeCommand);
    case PocEventKind::kFatalError: return freeze_halted(now, PocReason::kFatalError);
    case PocEventKind::kConfigComplete:
    case PocEventKind::kReady:
    case PocEventKind::kRun:
    case PocEventKind::kAllowColdstart:
    case PocEventKind::kWakeup:
    case PocEventKind::kAllSlots:
    case PocEventKind::kHalt: return ignore(now, PocReason::kCommandNotAccepted);
    case PocEventKind::kChannelActive:
    case PocEventKind::kChannelsIdle:
    case PocEventKind::kCasReceived:
    case PocEventKind::kWakeupPatternReceived:
    case PocEventKind::kHeaderReceived:
    case PocEventKind::kStartupFrame: return ignore(now, PocReason::kReceiverOff);
    case PocEventKind::kListenTimeout:
    case PocEventKind::kNoiseTimeout: return ignore(now, PocReason::kNoTimerRunning);
    case PocEventKind::kWakeupSent:
    case PocEventKind::kWakeupCollision: return ignore(now, PocReason::kNotSendingWakeup);
    case PocEventKind::kScheduleNotDerived: return ignore(now, PocReason::kNotDerivingSchedule);
    case PocEventKind::kClockCorrected:
    case PocEventKind::kCycleStarted: return ignore(now, PocReason::kNoSchedule);
  }
  return unlisted(now);
}

}  // namespace ttf::bus::poc
