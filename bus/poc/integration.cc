// The paths of nodes that take their schedule from another node: the following coldstart node (SPNU563A
// 26.2.6.7.4) and any other node (26.2.6.7.5).
#include "bus/poc/states.h"

namespace ttf::bus::poc {
namespace {

constexpr int kGoodDoubleCycles = 2;

PocStep one_more_cycle(const Now& now, PocReason why) {
  PocStep step = stay(now, why);
  ++step.next.cycles;
  return step;
}

PocStep begin_check(const Now& now) {
  if (now.event.cycle % 2 != 0) return ignore(now, PocReason::kNotYetWholeCycle);
  return one_more_cycle(now, PocReason::kFirstWholeCycle);
}

bool enough_frames(const StartupFramesSeen& seen) { return seen.reference_frame || seen.frames >= 2; }
bool enough_pairs(const StartupFramesSeen& seen) { return seen.reference_pair || seen.pairs >= 2; }

}  // namespace

// With coldstart allowed, coldstart listen replaces integration listen.
PocStep allow_coldstart_listening(const Now& now) {
  const PocStep step = allow_coldstart(now);
  const PocStep listening = listen_with(now.parameters, step);
  return listening.consequence == PocReason::kMayColdstart ? listening : step;
}

PocStep second_frame(const Now& now) {
  if (now.event.frame_id != now.state.reference || now.event.cycle % 2 == 0)
    return ignore(now, PocReason::kOddFrameAwaited);
  return enter(now,
               now.parameters.pKeySlotUsedForStartup ? PocKind::kIntegrationColdstartCheck
                                                     : PocKind::kIntegrationConsistencyCheck,
               PocReason::kScheduleDerived);
}

// Checks begin with the next even cycle; the rest of the cycle in which the schedule was derived is not judged.
PocStep note_clock_of_whole_cycles(const Now& now) {
  return now.state.cycles == 0 ? ignore(now, PocReason::kNotYetWholeCycle) : note_clock(now);
}

PocStep coldstart_check_cycle(const Now& now) {
  const StartupFramesSeen& ended = now.event.ended;
  if (now.state.cycles == 0) return begin_check(now);
  if (now.state.cycles == 1)  // the even cycle has ended
    return enough_frames(ended) ? one_more_cycle(now, PocReason::kReferenceFrameSeen)
                                : listen(now, PocReason::kReferenceFrameLost);
  if (!enough_pairs(ended)) return listen(now, PocReason::kReferencePairLost);
  if (const PocReason objection = clock_objection(now.state); objection != PocReason::kNone)
    return listen(now, objection);
  PocStep step = enter(now, PocKind::kColdstartJoin, PocReason::kReferenceConfirmed);
  step.next.cycles = 1;
  return step;
}

// The own frame does not count: at least the leading node's must be there. Cycles 4, 5, 6 are 1, 2, 3 here.
PocStep join_cycle(const Now& now) {
  const StartupFramesSeen& ended = now.event.ended;
  if (now.state.cycles == 2) {  // a double cycle has ended
    if (ended.pairs == 0) return listen(now, PocReason::kJoinedAlone);
    if (const PocReason objection = clock_objection(now.state); objection != PocReason::kNone)
      return listen(now, objection);
    return one_more_cycle(now, PocReason::kJoinGoesOn);
  }
  if (ended.frames == 0) return listen(now, PocReason::kJoinedAlone);
  if (now.state.cycles == 1) return one_more_cycle(now, PocReason::kJoinGoesOn);
  return enter(now, PocKind::kNormalActive, PocReason::kJoined);
}

// The first double cycle may have the leading node alone; then it is not counted as good.
PocStep integration_cycle(const Now& now) {
  const StartupFramesSeen& ended = now.event.ended;
  if (now.state.cycles == 0) return begin_check(now);
  const bool first = now.state.cycles <= 2;
  const bool even_ended = now.state.cycles % 2 != 0;
  if (even_ended) {
    if (first && !enough_frames(ended)) return listen(now, PocReason::kReferenceFrameLost);
    if (!first && ended.frames < 2) return listen(now, PocReason::kTooFewStartupFrames);
    return one_more_cycle(now, PocReason::kConsistencyGoesOn);
  }
  if (first && !enough_pairs(ended)) return listen(now, PocReason::kReferencePairLost);
  if (!first && ended.pairs < 2) return listen(now, PocReason::kTooFewStartupPairs);
  if (const PocReason objection = clock_objection(now.state); objection != PocReason::kNone)
    return listen(now, objection);
  PocStep step = one_more_cycle(now, PocReason::kConsistencyGoesOn);
  step.next.clock = ClockVerdict::kNone;
  step.next.good_double_cycles = ended.pairs >= 2 ? now.state.good_double_cycles + 1 : 0;
  if (step.next.good_double_cycles < kGoodDoubleCycles) return step;
  return enter(now, PocKind::kNormalActive, PocReason::kIntegrated);
}

}  // namespace ttf::bus::poc
