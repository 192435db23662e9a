// The parts of protocol operation control. table.cc has the answers to all events; the other files have the
// steps that do more than change the state.
#pragma once

#include "bus/poc/poc.h"

namespace ttf::bus::poc {

struct Now {
  const PocParameters& parameters;
  const PocState& state;
  const PocEvent& event;
};
using Answer = PocStep (*)(const ttf::bus::poc::Now&);

// Returns the one answer to an event in a state.
Answer answer(PocKind state, PocEventKind event);

// --- states.cc: steps that several states share

// Same state, same data: no effect.
PocStep ignore(const Now& now, PocReason why);
// Same state; the caller changes the data.
PocStep stay(const Now& now, PocReason why, PocActions actions = {});
// Another state; counts within a start-up state begin anew.
PocStep enter(const Now& now, PocKind kind, PocReason why, PocActions actions = {});

PocStep power_on(const Now& now);
PocStep ready(const Now& now, PocReason why);
PocStep halt(const Now& now, PocReason why);
PocStep freeze(const Now& now, PocReason why);
PocStep allow_coldstart(const Now& now);

// Startup prepare: enters coldstart listen if this node may coldstart, else integration listen; the
// consequence says which.
PocStep listen(const Now& now, PocReason why);
// The same for a step already in integration listen: RUN refills the attempts before it chooses.
PocStep listen_with(const PocParameters& parameters, PocStep step);
// Initialise schedule, with the even startup frame just received.
PocStep derive_schedule(const Now& now);

// Keeps the verdict of clock correction for the next cycle start.
PocStep note_clock(const Now& now);
// Returns why the verdict aborts start-up, kNone if it is in order. A missing verdict counts as a missing term.
PocReason clock_objection(const PocState& state);

// --- host.cc: states with the receiver off
PocStep configure_again(const Now& now);
PocStep run(const Now& now);
PocStep leave_halt(const Now& now);
PocStep freeze_halted(const Now& now, PocReason why);

// --- wakeup.cc
PocStep wake(const Now& now);
PocStep end_wakeup(const Now& now, WakeupStatus status, PocReason why);

// --- coldstart.cc: the path of the leading coldstart node
PocStep attempt_coldstart(const Now& now, PocReason why);
PocStep resolution_cycle(const Now& now);
PocStep consistency_cycle(const Now& now);

// --- integration.cc: the paths of the following coldstart node and of any other node
PocStep allow_coldstart_listening(const Now& now);
PocStep second_frame(const Now& now);
PocStep note_clock_of_whole_cycles(const Now& now);
PocStep coldstart_check_cycle(const Now& now);
PocStep join_cycle(const Now& now);
PocStep integration_cycle(const Now& now);

// --- normal.cc
PocStep request_halt(const Now& now);
PocStep request_ready(const Now& now);
PocStep request_all_slots(const Now& now);
PocStep count_clock(const Now& now);
PocStep active_cycle(const Now& now);
PocStep passive_cycle(const Now& now);

}  // namespace ttf::bus::poc
