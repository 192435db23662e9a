// Wake-up of one channel (SPNU563A 26.2.6.6, table 26-7): make sure that nobody communicates, send the wake-up
// pattern, find out about a collision. It always ends in ready, with its status; the host decides what follows.
#include "bus/poc_states.h"

namespace ttf::bus::poc {
namespace {

// Unlike READY this leaves coldstart inhibit as it is.
PocStep end(const Now& now, WakeupStatus status, PocReason why) {
  PocStep step = enter(now, PocKind::kReady, why);
  step.next.wakeup_status = status;
  return step;
}

}  // namespace

PocStep in_wakeup_listen(const Now& now) {
  switch (now.event.kind) {
    case PocEventKind::kPowerOn: return power_on(now);
    case PocEventKind::kFreeze: return freeze(now, PocReason::kFreezeCommand);
    case PocEventKind::kFatalError: return freeze(now, PocReason::kFatalError);
    case PocEventKind::kReady: return ready(now, PocReason::kReadyCommand);
    case PocEventKind::kAllowColdstart: return allow_coldstart(now);
    case PocEventKind::kConfig:
    case PocEventKind::kConfigComplete:
    case PocEventKind::kRun:
    case PocEventKind::kWakeup:
    case PocEventKind::kAllSlots:
    case PocEventKind::kHalt: return ignore(now, PocReason::kCommandNotAccepted);
    case PocEventKind::kChannelActive:
      return stay(now, PocReason::kListenTimerStopped, PocAction::kStopListenTimer);
    case PocEventKind::kChannelsIdle:
      return stay(now, PocReason::kListenTimerRestarted, PocAction::kRestartListenTimer);
    case PocEventKind::kWakeupPatternReceived:
      return end(now, WakeupStatus::kReceivedPattern, PocReason::kWakeupPatternHeard);
    case PocEventKind::kHeaderReceived: return end(now, WakeupStatus::kReceivedHeader, PocReason::kWakeupHeaderHeard);
    case PocEventKind::kListenTimeout:
      return enter(now, PocKind::kWakeupSend, PocReason::kWakeupAfterSilence, PocAction::kSendWakeupPattern);
    case PocEventKind::kNoiseTimeout:
      return enter(now, PocKind::kWakeupSend, PocReason::kWakeupAfterNoise, PocAction::kSendWakeupPattern);
    case PocEventKind::kCasReceived: return ignore(now, PocReason::kSymbolWithoutMeaning);
    case PocEventKind::kStartupFrame: return ignore(now, PocReason::kHeaderCameFirst);
    case PocEventKind::kWakeupSent:
    case PocEventKind::kWakeupCollision: return ignore(now, PocReason::kNotSendingWakeup);
    case PocEventKind::kScheduleNotDerived: return ignore(now, PocReason::kNotDerivingSchedule);
    case PocEventKind::kClockCorrected:
    case PocEventKind::kCycleStarted: return ignore(now, PocReason::kNoSchedule);
  }
  return unlisted(now);
}

PocStep in_wakeup_send(const Now& now) {
  switch (now.event.kind) {
    case PocEventKind::kPowerOn: return power_on(now);
    case PocEventKind::kFreeze: return freeze(now, PocReason::kFreezeCommand);
    case PocEventKind::kFatalError: return freeze(now, PocReason::kFatalError);
    case PocEventKind::kReady: return ready(now, PocReason::kReadyCommand);
    case PocEventKind::kAllowColdstart: return allow_coldstart(now);
    case PocEventKind::kWakeupSent: return end(now, WakeupStatus::kTransmitted, PocReason::kWakeupSent);
    case PocEventKind::kWakeupCollision:
      return enter(now, PocKind::kWakeupDetect, PocReason::kWakeupCollision, PocAction::kRestartListenTimer);
    case PocEventKind::kConfig:
    case PocEventKind::kConfigComplete:
    case PocEventKind::kRun:
    case PocEventKind::kWakeup:
    case PocEventKind::kAllSlots:
    case PocEventKind::kHalt: return ignore(now, PocReason::kCommandNotAccepted);
    // Sending, the receiver makes out nothing but a collision.
    case PocEventKind::kChannelActive:
    case PocEventKind::kChannelsIdle:
    case PocEventKind::kCasReceived:
    case PocEventKind::kWakeupPatternReceived:
    case PocEventKind::kHeaderReceived:
    case PocEventKind::kStartupFrame: return ignore(now, PocReason::kReceiverOff);
    case PocEventKind::kListenTimeout:
    case PocEventKind::kNoiseTimeout: return ignore(now, PocReason::kNoTimerRunning);
    case PocEventKind::kScheduleNotDerived: return ignore(now, PocReason::kNotDerivingSchedule);
    case PocEventKind::kClockCorrected:
    case PocEventKind::kCycleStarted: return ignore(now, PocReason::kNoSchedule);
  }
  return unlisted(now);
}

PocStep in_wakeup_detect(const Now& now) {
  switch (now.event.kind) {
    case PocEventKind::kPowerOn: return power_on(now);
    case PocEventKind::kFreeze: return freeze(now, PocReason::kFreezeCommand);
    case PocEventKind::kFatalError: return freeze(now, PocReason::kFatalError);
    case PocEventKind::kReady: return ready(now, PocReason::kReadyCommand);
    case PocEventKind::kAllowColdstart: return allow_coldstart(now);
    case PocEventKind::kWakeupPatternReceived:
      return end(now, WakeupStatus::kCollisionPattern, PocReason::kCollisionWithPattern);
    case PocEventKind::kHeaderReceived:
      return end(now, WakeupStatus::kCollisionHeader, PocReason::kCollisionWithHeader);
    case PocEventKind::kListenTimeout:
      return end(now, WakeupStatus::kCollisionUnknown, PocReason::kCollisionUnexplained);
    case PocEventKind::kConfig:
    case PocEventKind::kConfigComplete:
    case PocEventKind::kRun:
    case PocEventKind::kWakeup:
    case PocEventKind::kAllSlots:
    case PocEventKind::kHalt: return ignore(now, PocReason::kCommandNotAccepted);
    // The timer bounds the search whatever the channel does.
    case PocEventKind::kChannelActive:
    case PocEventKind::kChannelsIdle: return ignore(now, PocReason::kNoTimerOnChannel);
    case PocEventKind::kCasReceived: return ignore(now, PocReason::kSymbolWithoutMeaning);
    case PocEventKind::kStartupFrame: return ignore(now, PocReason::kHeaderCameFirst);
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
