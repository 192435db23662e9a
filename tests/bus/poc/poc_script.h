// A scripted protocol operation control: it takes single events, or is led to a state as by a controller.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bus/poc/poc.h"

namespace ttf::bus::poc {

using Kind = PocKind;
using Event = PocEventKind;

inline constexpr int kReference = 1;  // frame id of the followed node
inline constexpr StartupFramesSeen kNobody{};
inline constexpr StartupFramesSeen kLeaderOnly{1, 1, true, true};
inline constexpr StartupFramesSeen kTwoNodes{2, 2, true, true};

inline PocParameters coldstart_node() {
  return {.pKeySlotUsedForStartup = true,
          .pKeySlotOnlyEnabled = false,
          .gColdStartAttempts = 4,
          .gMaxWithoutClockCorrectionPassive = 2,
          .gMaxWithoutClockCorrectionFatal = 4,
          .pAllowPassiveToActive = 3,
          .pAllowHaltDueToClock = true,
          .pdListenTimeout = 400'000,
          .gListenNoise = 2};
}

inline PocParameters other_node() {
  PocParameters parameters = coldstart_node();
  parameters.pKeySlotUsedForStartup = false;
  return parameters;
}

class PocScript {
 public:
  explicit PocScript(const PocParameters& p) : parameters(p), state(poc_power_on(p)) {}

  PocScript& apply(const PocEvent& event) {
    last = poc_step(parameters, state, event);
    state = last.next;
    return *this;
  }
  PocScript& apply(Event kind) { return apply(PocEvent{kind}); }

  // The next cycle begins; `ended` lists the startup frames of the cycle before.
  PocScript& cycle(const StartupFramesSeen& ended = kNobody) {
    if (last_cycle % 2 != 0 && last_cycle >= 0) correct_clock();
    ++last_cycle;
    return apply(PocEvent::cycle_started(last_cycle, ended));
  }
  PocScript& cycles(int count, const StartupFramesSeen& ended) {
    for (int i = 0; i < count; ++i) cycle(ended);
    return *this;
  }

  PocScript& to_ready() { return apply(Event::kConfig).apply(Event::kConfigComplete); }
  PocScript& to_listen() { return to_ready().apply(Event::kAllowColdstart).apply(Event::kRun); }
  PocScript& to_collision_resolution() {
    to_listen().apply(Event::kListenTimeout);
    last_cycle = -1;
    return *this;
  }
  // Cycle 4 has begun.
  PocScript& to_consistency_check() { return to_collision_resolution().cycles(5, kNobody); }
  PocScript& to_gap() { return to_consistency_check().cycle(kNobody); }
  PocScript& to_initialise_schedule() { return to_listen().apply(PocEvent::startup_frame(kReference, 0)); }
  // In cycle 1, behind the second frame.
  PocScript& to_check() {
    to_initialise_schedule().apply(PocEvent::startup_frame(kReference, 1));
    last_cycle = 1;
    return *this;
  }
  // Cycle 4 has begun.
  PocScript& to_join() { return to_check().cycle().cycles(2, kLeaderOnly); }
  // Cycle 7 has begun for a coldstart node, cycle 6 for another.
  PocScript& to_active() {
    return parameters.pKeySlotUsedForStartup ? to_join().cycles(3, kTwoNodes) : to_check().cycle().cycles(4, kTwoNodes);
  }
  // Double cycles with this outcome of clock correction, from one running odd cycle to the next.
  PocScript& double_cycles(int count, bool missing, bool limit_exceeded = false) {
    for (int i = 0; i < count; ++i) {
      apply(PocEvent::clock_corrected(missing, limit_exceeded));
      apply(PocEvent::cycle_started(++last_cycle, kTwoNodes));
      apply(PocEvent::cycle_started(++last_cycle, kTwoNodes));
    }
    return *this;
  }
  PocScript& to_passive() {
    to_active();
    if (last_cycle % 2 == 0) cycle(kTwoNodes);
    return double_cycles(parameters.gMaxWithoutClockCorrectionPassive, true);
  }

  PocScript& correct_clock() { return apply(PocEvent::clock_corrected(clock_missing, clock_limit)); }

  PocParameters parameters;
  PocState state;
  PocStep last;
  int last_cycle = -1;         // that began
  bool clock_missing = false;  // the outcome that cycle() reports in odd cycles
  bool clock_limit = false;
};

}  // namespace ttf::bus::poc
