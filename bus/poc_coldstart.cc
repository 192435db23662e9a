// The path of the leading coldstart node (SPNU563A 26.2.6.7.2 and 26.2.6.7.3).
#include "bus/poc_states.h"

namespace ttf::bus::poc {
namespace {

constexpr int kResolutionCycles = 4;

PocStep attempt(const Now& now, PocReason why) {
  PocStep step = enter(now, PocKind::kColdstartCollisionResolution, why, PocAction::kSendCas);
  --step.next.vRemainingColdstartAttempts;   // listening needs more than one, so at least one stays
  step.next.coldstart_noise = why == PocReason::kColdstartAfterNoise;
  return step;
}

}  // namespace

PocStep in_coldstart_listen(const Now& now) {
  switch (now.event.kind) {
    case PocEventKind::kPowerOn: return power_on(now);
    case PocEventKind::kFreeze: return freeze(now, PocReason::kFreezeCommand);
    case PocEventKind::kFatalError: return freeze(now, PocReason::kFatalError);
    case PocEventKind::kReady: return ready(now, PocReason::kReadyCommand);
    case PocEventKind::kStartupFrame: return derive_schedule(now);
    case PocEventKind::kListenTimeout: return attempt(now, PocReason::kColdstartAfterSilence);
    case PocEventKind::kNoiseTimeout: return attempt(now, PocReason::kColdstartAfterNoise);
    case PocEventKind::kChannelActive:
      return stay(now, PocReason::kListenTimerStopped, PocAction::kStopListenTimer);
    case PocEventKind::kChannelsIdle:
      return stay(now, PocReason::kListenTimerRestarted, PocAction::kRestartListenTimer);
    // These are no noise: somebody starts the cluster or runs it.
    case PocEventKind::kCasReceived:
    case PocEventKind::kHeaderReceived:
      return stay(now, PocReason::kNoiseTimerRestarted, PocAction::kRestartNoiseTimer);
    case PocEventKind::kConfig:
    case PocEventKind::kConfigComplete:
    case PocEventKind::kRun:
    case PocEventKind::kAllowColdstart:   // it is allowed already, else it would not be here
    case PocEventKind::kWakeup:
    case PocEventKind::kAllSlots:
    case PocEventKind::kHalt: return ignore(now, PocReason::kCommandNotAccepted);
    case PocEventKind::kWakeupPatternReceived: return ignore(now, PocReason::kNoWakeupWanted);
    case PocEventKind::kWakeupSent:
    case PocEventKind::kWakeupCollision: return ignore(now, PocReason::kNotSendingWakeup);
    case PocEventKind::kScheduleNotDerived: return ignore(now, PocReason::kNotDerivingSchedule);
    case PocEventKind::kClockCorrected:
    case PocEventKind::kCycleStarted: return ignore(now, PocReason::kNoSchedule);
  }
  return unlisted(now);
}

namespace {

PocStep resolution_cycle(const Now& now) {
  if (now.state.cycles < kResolutionCycles) {
    PocStep step = stay(now, PocReason::kCollisionResolutionGoesOn);
    ++step.next.cycles;
    return step;
  }
  PocStep step = enter(now, PocKind::kColdstartConsistencyCheck, PocReason::kAloneForFourCycles);
  step.next.cycles = 1;
  return step;
}

}  // namespace

PocStep in_collision_resolution(const Now& now) {
  switch (now.event.kind) {
    case PocEventKind::kPowerOn: return power_on(now);
    case PocEventKind::kFreeze: return freeze(now, PocReason::kFreezeCommand);
    case PocEventKind::kFatalError: return freeze(now, PocReason::kFatalError);
    case PocEventKind::kReady: return ready(now, PocReason::kReadyCommand);
    // Another node leads as well: who hears it gives way, so that one remains.
    case PocEventKind::kCasReceived: return listen(now, PocReason::kCollisionCas);
    case PocEventKind::kHeaderReceived: return listen(now, PocReason::kCollisionHeader);
    case PocEventKind::kCycleStarted: return resolution_cycle(now);
    case PocEventKind::kConfig:
    case PocEventKind::kConfigComplete:
    case PocEventKind::kRun:
    case PocEventKind::kAllowColdstart:   // it is allowed already
    case PocEventKind::kWakeup:
    case PocEventKind::kAllSlots:
    case PocEventKind::kHalt: return ignore(now, PocReason::kCommandNotAccepted);
    case PocEventKind::kChannelActive:
    case PocEventKind::kChannelsIdle: return ignore(now, PocReason::kNoTimerOnChannel);
    case PocEventKind::kWakeupPatternReceived: return ignore(now, PocReason::kNoWakeupWanted);
    case PocEventKind::kStartupFrame: return ignore(now, PocReason::kHeaderCameFirst);
    case PocEventKind::kListenTimeout:
    case PocEventKind::kNoiseTimeout: return ignore(now, PocReason::kNoTimerRunning);
    case PocEventKind::kWakeupSent:
    case PocEventKind::kWakeupCollision: return ignore(now, PocReason::kNotSendingWakeup);
    case PocEventKind::kScheduleNotDerived: return ignore(now, PocReason::kNotDerivingSchedule);
    case PocEventKind::kClockCorrected: return ignore(now, PocReason::kOwnClockOnly);
  }
  return unlisted(now);
}

namespace {

PocStep gap(const Now& now) {
  if (now.state.vRemainingColdstartAttempts == 0) return listen(now, PocReason::kNobodyJoined);
  PocStep step = enter(now, PocKind::kColdstartGap, PocReason::kNobodyJoined);
  --step.next.vRemainingColdstartAttempts;
  return step;
}

PocStep consistency_cycle(const Now& now) {
  if (now.state.cycles == 1) {   // cycle 4 has ended
    if (now.event.ended.frames == 0) return gap(now);
    PocStep step = stay(now, PocReason::kSomebodyJoined);
    step.next.cycles = 2;
    return step;
  }
  if (now.event.ended.pairs == 0) return listen(now, PocReason::kNoStartupPair);
  if (const PocReason objection = clock_objection(now.state); objection != PocReason::kNone)
    return listen(now, objection);
  return enter(now, PocKind::kNormalActive, PocReason::kClusterStarted);
}

}  // namespace

PocStep in_consistency_check(const Now& now) {
  switch (now.event.kind) {
    case PocEventKind::kPowerOn: return power_on(now);
    case PocEventKind::kFreeze: return freeze(now, PocReason::kFreezeCommand);
    case PocEventKind::kFatalError: return freeze(now, PocReason::kFatalError);
    case PocEventKind::kReady: return ready(now, PocReason::kReadyCommand);
    case PocEventKind::kCycleStarted: return consistency_cycle(now);
    case PocEventKind::kClockCorrected: return note_clock(now);
    case PocEventKind::kConfig:
    case PocEventKind::kConfigComplete:
    case PocEventKind::kRun:
    case PocEventKind::kAllowColdstart:   // it is allowed already
    case PocEventKind::kWakeup:
    case PocEventKind::kAllSlots:
    case PocEventKind::kHalt: return ignore(now, PocReason::kCommandNotAccepted);
    case PocEventKind::kChannelActive:
    case PocEventKind::kChannelsIdle: return ignore(now, PocReason::kNoTimerOnChannel);
    case PocEventKind::kCasReceived: return ignore(now, PocReason::kSymbolWithoutMeaning);
    case PocEventKind::kWakeupPatternReceived: return ignore(now, PocReason::kNoWakeupWanted);
    case PocEventKind::kHeaderReceived:
    case PocEventKind::kStartupFrame: return ignore(now, PocReason::kJudgedAtCycleEnd);
    case PocEventKind::kListenTimeout:
    case PocEventKind::kNoiseTimeout: return ignore(now, PocReason::kNoTimerRunning);
    case PocEventKind::kWakeupSent:
    case PocEventKind::kWakeupCollision: return ignore(now, PocReason::kNotSendingWakeup);
    case PocEventKind::kScheduleNotDerived: return ignore(now, PocReason::kNotDerivingSchedule);
  }
  return unlisted(now);
}

PocStep in_gap(const Now& now) {
  switch (now.event.kind) {
    case PocEventKind::kPowerOn: return power_on(now);
    case PocEventKind::kFreeze: return freeze(now, PocReason::kFreezeCommand);
    case PocEventKind::kFatalError: return freeze(now, PocReason::kFatalError);
    case PocEventKind::kReady: return ready(now, PocReason::kReadyCommand);
    case PocEventKind::kCasReceived: return listen(now, PocReason::kGapCas);
    case PocEventKind::kHeaderReceived: return listen(now, PocReason::kGapHeader);
    // The attempt was taken off when the gap was entered.
    case PocEventKind::kCycleStarted:
      return enter(now, PocKind::kColdstartCollisionResolution, PocReason::kGapOver, PocAction::kSendCas);
    case PocEventKind::kConfig:
    case PocEventKind::kConfigComplete:
    case PocEventKind::kRun:
    case PocEventKind::kAllowColdstart:   // it is allowed already
    case PocEventKind::kWakeup:
    case PocEventKind::kAllSlots:
    case PocEventKind::kHalt: return ignore(now, PocReason::kCommandNotAccepted);
    case PocEventKind::kChannelActive:
    case PocEventKind::kChannelsIdle: return ignore(now, PocReason::kNoTimerOnChannel);
    case PocEventKind::kWakeupPatternReceived: return ignore(now, PocReason::kNoWakeupWanted);
    case PocEventKind::kStartupFrame: return ignore(now, PocReason::kHeaderCameFirst);
    case PocEventKind::kListenTimeout:
    case PocEventKind::kNoiseTimeout: return ignore(now, PocReason::kNoTimerRunning);
    case PocEventKind::kWakeupSent:
    case PocEventKind::kWakeupCollision: return ignore(now, PocReason::kNotSendingWakeup);
    case PocEventKind::kScheduleNotDerived: return ignore(now, PocReason::kNotDerivingSchedule);
    case PocEventKind::kClockCorrected: return ignore(now, PocReason::kOwnClockOnly);
  }
  return unlisted(now);
}

}  // namespace ttf::bus::poc
