// The reasons of steps of protocol operation control: one for every (state, event) pair, with one sentence each.
#pragma once

#include <cstdint>
#include <string_view>

namespace ttf::bus::poc {

enum class PocReason : std::uint8_t {
  kNone,

  // Host, supply, errors.
  kPowerOn,
  kConfigCommand,
  kLeftHalt,
  kConfigured,
  kRunCommand,
  kReadyCommand,
  kReadyRequested,
  kReadyAtCycleEnd,
  kHaltRequested,
  kHaltAtCycleEnd,
  kFreezeCommand,
  kFatalError,
  kColdstartAllowed,
  kAllSlotsRequested,

  // Wake-up.
  kWakeupCommand,
  kWakeupAfterSilence,
  kWakeupAfterNoise,
  kWakeupPatternReceived,
  kWakeupHeaderReceived,
  kWakeupSent,
  kWakeupCollision,
  kCollisionWithPattern,
  kCollisionWithHeader,
  kCollisionUnexplained,

  // The direction of start-up (PocStep::consequence).
  kMayColdstart,
  kNotAColdstartNode,
  kColdstartInhibited,
  kAttemptsExhausted,

  // Listening.
  kListenTimerStopped,
  kListenTimerRestarted,
  kNoiseTimerRestarted,
  kStartupFrameReceived,

  // Leading coldstart node.
  kColdstartAfterSilence,
  kColdstartAfterNoise,
  kCollisionResolutionGoesOn,
  kCollisionCas,
  kCollisionHeader,
  kAloneForFourCycles,
  kSomebodyJoined,
  kNobodyJoined,
  kGapCas,
  kGapHeader,
  kGapOver,
  kNoStartupPair,
  kClusterStarted,

  // Following and integrating nodes.
  kScheduleDerived,
  kScheduleNotDerived,
  kFirstWholeCycle,
  kReferenceFrameSeen,
  kReferenceFrameLost,
  kReferencePairLost,
  kReferenceConfirmed,
  kJoinGoesOn,
  kJoinedAlone,
  kJoined,
  kConsistencyGoesOn,
  kTooFewStartupFrames,
  kTooFewStartupPairs,
  kIntegrated,

  // Clock correction.
  kClockInOrder,
  kClockTermMissing,
  kClockLimitExceeded,
  kStartupClockTermMissing,
  kStartupClockLimitExceeded,
  kPassiveByMissingTerms,
  kPassiveByLimit,
  kHaltByMissingTerms,
  kHaltByLimit,
  kBackToActive,
  kCycleGoesOn,
  kStaysPassive,

  // Reasons of steps without effect.
  kCommandNotAccepted,
  kAlreadyFrozen,
  kReceiverOff,
  kNoTimerRunning,
  kNoTimerOnChannel,
  kNotDerivingSchedule,
  kNotSendingWakeup,
  kNoSchedule,
  kNoWakeupWanted,
  kSymbolWithoutMeaning,
  kHeaderWithoutMeaning,
  kEvenFrameAwaited,
  kOddFrameAwaited,
  kHeaderCameFirst,
  kJudgedAtCycleEnd,
  kOwnClockOnly,
  kNotYetWholeCycle,
};

// Returns one sentence without the final stop, for the log; empty for kNone.
std::string_view to_text(PocReason reason);

// Returns whether the reason means no effect: same state, same data, no action.
constexpr bool is_ignored(PocReason reason) { return reason >= PocReason::kCommandNotAccepted; }

}  // namespace ttf::bus::poc
