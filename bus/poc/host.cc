// The states in which the controller is deaf and does what its host says.
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

// Everything but how the node came here is forgotten with the way out: E-Ray resets FSI, HRQ, PSL and the slot mode.
PocStep leave_halt(const Now& now) {
  return {poc_power_on(now.parameters), {}, PocReason::kLeftHalt, PocReason::kNone};
}

// A node halted otherwise is marked as frozen after all; where it came from then was halt (E-Ray CCSV.PSL).
PocStep freeze_halted(const Now& now, PocReason why) {
  if (now.state.frozen) return ignore(now, PocReason::kAlreadyFrozen);
  return freeze(now, why);
}

}  // namespace ttf::bus::poc
