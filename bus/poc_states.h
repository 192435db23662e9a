// Inside protocol operation control: one function per state, each listing every event, and what several of them share.
#pragma once

#include "bus/poc.h"

namespace ttf::bus::poc {

struct Now {
  const PocParameters& parameters;
  const PocState& state;
  const PocEvent& event;
};

PocStep in_default_config(const Now& now);
PocStep in_config(const Now& now);
PocStep in_ready(const Now& now);
PocStep in_halt(const Now& now);
PocStep in_wakeup_listen(const Now& now);
PocStep in_wakeup_send(const Now& now);
PocStep in_wakeup_detect(const Now& now);
PocStep in_coldstart_listen(const Now& now);
PocStep in_collision_resolution(const Now& now);
PocStep in_consistency_check(const Now& now);
PocStep in_gap(const Now& now);
PocStep in_integration_listen(const Now& now);
PocStep in_initialise_schedule(const Now& now);
PocStep in_integration_coldstart_check(const Now& now);
PocStep in_join(const Now& now);
PocStep in_integration_consistency_check(const Now& now);
PocStep in_normal_active(const Now& now);
PocStep in_normal_passive(const Now& now);

// The end of every function above: reached only with an event that is none.
[[noreturn]] PocStep unlisted(const Now& now);

// Same state, same data: nothing happens.
PocStep ignore(const Now& now, PocReason why);
// Same state, data to be changed by the caller.
PocStep stay(const Now& now, PocReason why, PocActions actions = {});
// Another state; what counts within a state of start-up begins anew.
PocStep enter(const Now& now, PocKind kind, PocReason why, PocActions actions = {});

PocStep power_on(const Now& now);
PocStep ready(const Now& now, PocReason why);
PocStep halt(const Now& now, PocReason why);
PocStep freeze(const Now& now, PocReason why);
PocStep allow_coldstart(const Now& now);

// Startup prepare: to coldstart listen if this node may coldstart, else to integration listen; the consequence says
// which.
PocStep listen(const Now& now, PocReason why);
// The same for a step that has come to integration listen already: RUN refills the attempts before it chooses.
PocStep listen_with(const PocParameters& parameters, PocStep step);
// Initialise schedule, with the even startup frame that was heard.
PocStep derive_schedule(const Now& now);

// Keeps the verdict of clock correction for the next cycle start.
PocStep note_clock(const Now& now);
// Why start-up is aborted on the verdict, kNone if it is in order. No verdict at all counts as a missing term.
PocReason clock_objection(const PocState& state);

}  // namespace ttf::bus::poc
