// Wake-up of one channel (SPNU563A 26.2.6.6, table 26-7): checks that no node communicates, sends the wake-up
// pattern, and detects a collision. It always ends in ready, with its status; the host decides what follows.
#include "bus/poc/states.h"

namespace ttf::bus::poc {

PocStep wake(const Now& now) {
  PocStep step = enter(now, PocKind::kWakeupListen, PocReason::kWakeupCommand,
                       PocActions(PocAction::kRestartListenTimer) | PocAction::kRestartNoiseTimer);
  step.next.wakeup_status = WakeupStatus::kUndefined;
  return step;
}

// Unlike READY this leaves coldstart inhibit as it is.
PocStep end_wakeup(const Now& now, WakeupStatus status, PocReason why) {
  PocStep step = enter(now, PocKind::kReady, why);
  step.next.wakeup_status = status;
  return step;
}

}  // namespace ttf::bus::poc
