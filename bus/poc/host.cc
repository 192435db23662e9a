// Steps in the states with the receiver off, where the host decides.
#include "bus/poc/states.h"

namespace ttf::bus::poc {

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

// Leaving halt clears everything, as E-Ray resets FSI, HRQ, PSL and the slot mode.
PocStep leave_halt(const Now& now) {
  return {poc_power_on(now.parameters), {}, PocReason::kLeftHalt, PocReason::kNone};
}

// FREEZE marks a halted node as frozen; it then comes from halt (E-Ray CCSV.PSL).
PocStep freeze_halted(const Now& now, PocReason why) {
  if (now.state.frozen) return ignore(now, PocReason::kAlreadyFrozen);
  return freeze(now, why);
}

}  // namespace ttf::bus::poc
