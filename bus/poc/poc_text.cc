#include "bus/poc/poc.h"

namespace ttf::bus::poc {

std::string_view to_text(PocEventKind kind) {
  switch (kind) {
    case PocEventKind::kPowerOn: return "power on";
    case PocEventKind::kConfig: return "CONFIG";
    case PocEventKind::kConfigComplete: return "CONFIG_COMPLETE";
    case PocEventKind::kReady: return "READY";
    case PocEventKind::kRun: return "RUN";
    case PocEventKind::kAllowColdstart: return "ALLOW_COLDSTART";
    case PocEventKind::kWakeup: return "WAKEUP";
    case PocEventKind::kAllSlots: return "ALL_SLOTS";
    case PocEventKind::kHalt: return "HALT";
    case PocEventKind::kFreeze: return "FREEZE";
    case PocEventKind::kFatalError: return "fatal error";
    case PocEventKind::kChannelActive: return "channel active";
    case PocEventKind::kChannelsIdle: return "channels idle";
    case PocEventKind::kCasReceived: return "CAS received";
    case PocEventKind::kWakeupPatternReceived: return "wakeup pattern received";
    case PocEventKind::kHeaderReceived: return "frame header received";
    case PocEventKind::kStartupFrame: return "startup frame received";
    case PocEventKind::kListenTimeout: return "listen timeout";
    case PocEventKind::kNoiseTimeout: return "noise listen timeout";
    case PocEventKind::kWakeupSent: return "wakeup pattern sent";
    case PocEventKind::kWakeupCollision: return "wakeup collision";
    case PocEventKind::kScheduleNotDerived: return "schedule not derived";
    case PocEventKind::kClockCorrected: return "clock correction computed";
    case PocEventKind::kCycleStarted: return "cycle started";
  }
  return "";
}

std::string_view to_text(PocReason reason) {
  switch (reason) {
    case PocReason::kNone: return "";

    case PocReason::kPowerOn: return "power came on";
    case PocReason::kConfigCommand: return "the host commanded CONFIG";
    case PocReason::kLeftHalt: return "the host took the node out of halt";
    case PocReason::kConfigured: return "the host completed the configuration";
    case PocReason::kRunCommand: return "the host commanded RUN";
    case PocReason::kReadyCommand: return "the host commanded READY, which ends wake-up and start-up at once";
    case PocReason::kReadyRequested: return "the host commanded READY: it takes effect at the end of the cycle";
    case PocReason::kReadyAtCycleEnd: return "the cycle in which the host commanded READY has ended";
    case PocReason::kHaltRequested: return "the host commanded HALT: it takes effect at the end of the cycle";
    case PocReason::kHaltAtCycleEnd: return "the cycle in which the host commanded HALT has ended";
    case PocReason::kFreezeCommand: return "the host commanded FREEZE";
    case PocReason::kFatalError: return "the controller found a fatal error";
    case PocReason::kColdstartAllowed: return "the host allowed the node to start the cluster";
    case PocReason::kAllSlotsRequested:
      return "the host commanded ALL_SLOTS: all slots are sent from the next cycle on";

    case PocReason::kWakeupCommand: return "the host commanded WAKEUP";
    case PocReason::kWakeupAfterSilence: return "the channels were idle for the listen timeout: the pattern is sent";
    case PocReason::kWakeupAfterNoise:
      return "neither a frame nor a wake-up pattern came within the noise listen timeout: the pattern is sent";
    case PocReason::kWakeupPatternReceived: return "another node sent a wake-up pattern first";
    case PocReason::kWakeupHeaderReceived: return "a frame header was heard: the cluster is awake";
    case PocReason::kWakeupSent: return "the wake-up pattern was sent completely";
    case PocReason::kWakeupCollision: return "another node sent on the channel during the pattern";
    case PocReason::kCollisionWithPattern: return "the pattern collided with another node's wake-up pattern";
    case PocReason::kCollisionWithHeader: return "the pattern collided with running communication";
    case PocReason::kCollisionUnexplained: return "the cause of the collision did not show within the listen timeout";

    case PocReason::kMayColdstart: return "it may start the cluster if no other node does";
    case PocReason::kNotAColdstartNode: return "it is not a coldstart node and waits for a running schedule";
    case PocReason::kColdstartInhibited: return "coldstart is inhibited until the host allows it";
    case PocReason::kAttemptsExhausted: return "its coldstart attempts are exhausted: it can only join others";

    case PocReason::kListenTimerStopped: return "a channel became active: the listen timer stops";
    case PocReason::kListenTimerRestarted: return "the channels are idle again: the listen timer starts again";
    case PocReason::kNoiseTimerRestarted: return "a symbol or frame header was heard: the noise timer starts again";
    case PocReason::kStartupFrameReceived:
      return "a startup frame of an even cycle was heard: its sender's schedule is tried";

    case PocReason::kColdstartAfterSilence:
      return "the channels were idle for the listen timeout: it sends a collision avoidance symbol to start the "
             "cluster";
    case PocReason::kColdstartAfterNoise:
      return "only noise came within the noise listen timeout: it sends a collision avoidance symbol to start "
             "the cluster";
    case PocReason::kCollisionResolutionGoesOn: return "no other node has tried to start the cluster so far";
    case PocReason::kCollisionCas: return "another node's collision avoidance symbol was heard: it gives way";
    case PocReason::kCollisionHeader: return "another node's frame was heard in the first four cycles: it gives way";
    case PocReason::kAloneForFourCycles: return "no other node tried to start the cluster in four cycles: it leads";
    case PocReason::kSomebodyJoined: return "another node's startup frame came in the first cycle of the check";
    case PocReason::kNobodyJoined: return "no other node's startup frame came in the first cycle of the check";
    case PocReason::kGapCas: return "another node's collision avoidance symbol was heard in the silent cycle";
    case PocReason::kGapHeader: return "another node's frame was heard in the silent cycle";
    case PocReason::kGapOver: return "the silent cycle is over: it sends a collision avoidance symbol once more";
    case PocReason::kNoStartupPair: return "no other node's startup frames came in both cycles of the check";
    case PocReason::kClusterStarted:
      return "another coldstart node's startup frames fit its schedule: the cluster is started";

    case PocReason::kScheduleDerived: return "the second startup frame of the same node came: its schedule is taken";
    case PocReason::kScheduleNotDerived: return "no second startup frame of the same node came where it was due";
    case PocReason::kFirstWholeCycle: return "the first whole cycle on the taken schedule begins";
    case PocReason::kReferenceFrameSeen: return "startup frames of the node it follows still come where they are due";
    case PocReason::kReferenceFrameLost:
      return "in the even cycle neither the node it follows nor two others sent a startup frame";
    case PocReason::kReferencePairLost:
      return "in the double cycle neither the node it follows nor two others sent a pair of startup frames";
    case PocReason::kReferenceConfirmed:
      return "its schedule agrees with the leading node's: it sends its startup frame";
    case PocReason::kJoinGoesOn: return "another node's startup frames come where they are due";
    case PocReason::kJoinedAlone: return "no other node's startup frames came while it sent its own";
    case PocReason::kJoined: return "it has sent its startup frame along with others for three cycles";
    case PocReason::kConsistencyGoesOn: return "enough startup frames come where they are due";
    case PocReason::kTooFewStartupFrames: return "fewer than two startup frames came in an even cycle";
    case PocReason::kTooFewStartupPairs: return "fewer than two pairs of startup frames came in a double cycle";
    case PocReason::kIntegrated: return "two pairs of startup frames came in two consecutive double cycles";

    case PocReason::kClockInOrder: return "clock correction is in order";
    case PocReason::kClockTermMissing: return "a term of clock correction is missing";
    case PocReason::kClockLimitExceeded: return "a term of clock correction is beyond its limit";
    case PocReason::kStartupClockTermMissing: return "a term of clock correction was missing during start-up";
    case PocReason::kStartupClockLimitExceeded:
      return "a term of clock correction was beyond its limit during start-up";
    case PocReason::kPassiveByMissingTerms:
      return "clock correction failed in gMaxWithoutClockCorrectionPassive double cycles in a row";
    case PocReason::kPassiveByLimit: return "a term of clock correction was beyond its limit: it falls silent";
    case PocReason::kHaltByMissingTerms:
      return "clock correction failed in gMaxWithoutClockCorrectionFatal double cycles in a row";
    case PocReason::kHaltByLimit: return "a term of clock correction was beyond its limit: it stops";
    case PocReason::kBackToActive:
      return "clock correction was in order for pAllowPassiveToActive double cycles in a row";
    case PocReason::kCycleGoesOn: return "the next cycle begins";
    case PocReason::kStaysPassive: return "the next cycle begins, and the node may not send yet";

    case PocReason::kCommandNotAccepted: return "the command is not accepted in this state";
    case PocReason::kAlreadyFrozen: return "it is frozen already";
    case PocReason::kReceiverOff: return "the receiver is off in this state";
    case PocReason::kNoTimerRunning: return "this timer does not run in this state";
    case PocReason::kNoTimerOnChannel: return "no timer depends on the channel in this state";
    case PocReason::kNotDerivingSchedule: return "no schedule is being derived in this state";
    case PocReason::kNotSendingWakeup: return "no wake-up pattern is being sent in this state";
    case PocReason::kNoSchedule: return "no schedule runs in this state";
    case PocReason::kNoWakeupWanted: return "the node is awake: a wake-up pattern has no effect";
    case PocReason::kSymbolWithoutMeaning: return "a collision avoidance symbol has no effect in this state";
    case PocReason::kHeaderWithoutMeaning: return "a single frame has no effect in this state";
    case PocReason::kEvenFrameAwaited: return "a schedule begins with a startup frame of an even cycle";
    case PocReason::kOddFrameAwaited: return "only the odd cycle's startup frame of the same node completes the pair";
    case PocReason::kHeaderCameFirst: return "the frame's header has been judged already";
    case PocReason::kJudgedAtCycleEnd: return "startup frames are judged together at the end of the cycle";
    case PocReason::kOwnClockOnly: return "its own frame alone does not measure its clock";
    case PocReason::kNotYetWholeCycle: return "the checks begin with the first whole double cycle";
  }
  return "";
}

}  // namespace ttf::bus::poc
