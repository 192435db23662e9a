// The path of the leading coldstart node (SPNU563A 26.2.6.7.2 and 26.2.6.7.3).
#include "bus/poc/states.h"

namespace ttf::bus::poc {
namespace {

constexpr int kResolutionCycles = 4;

PocStep gap(const Now& now) {
  if (now.state.vRemainingColdstartAttempts == 0) return listen(now, PocReason::kNobodyJoined);
  PocStep step = enter(now, PocKind::kColdstartGap, PocReason::kNobodyJoined);
  --step.next.vRemainingColdstartAttempts;
  return step;
}

}  // namespace

PocStep attempt_coldstart(const Now& now, PocReason why) {
  PocStep step = enter(now, PocKind::kColdstartCollisionResolution, why, PocAction::kSendCas);
  --step.next.vRemainingColdstartAttempts;  // listening needs more than one, so at least one remains
  step.next.coldstart_noise = why == PocReason::kColdstartAfterNoise;
  return step;
}

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

PocStep consistency_cycle(const Now& now) {
  if (now.state.cycles == 1) {  // cycle 4 has ended
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

}  // namespace ttf::bus::poc
