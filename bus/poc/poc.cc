#include "bus/poc/poc.h"

#include "bus/poc/states.h"

namespace ttf::bus::poc {
namespace {

bool runs_timers(PocKind kind) { return listen_timer_follows_channels(kind) || kind == PocKind::kWakeupDetect; }

}  // namespace

PocParameters poc_parameters(const schedules::model::GlobalParameters& global,
                             const schedules::model::NodeParameters& node) {
  return {.pKeySlotUsedForStartup = node.pKeySlotUsedForStartup,
          .pKeySlotOnlyEnabled = node.pKeySlotOnlyEnabled,
          .gColdStartAttempts = global.gColdStartAttempts,
          .gMaxWithoutClockCorrectionPassive = global.gMaxWithoutClockCorrectionPassive,
          .gMaxWithoutClockCorrectionFatal = global.gMaxWithoutClockCorrectionFatal,
          .pAllowPassiveToActive = node.pAllowPassiveToActive,
          .pAllowHaltDueToClock = node.pAllowHaltDueToClock,
          .pdListenTimeout = node.pdListenTimeout,
          .gListenNoise = global.gListenNoise};
}

PocState poc_power_on(const PocParameters& parameters) {
  PocState state;
  state.vRemainingColdstartAttempts = parameters.gColdStartAttempts;
  state.slot_mode = parameters.pKeySlotOnlyEnabled ? SlotMode::kKeySlotOnly : SlotMode::kAll;
  return state;
}

PocStep poc_step(const PocParameters& parameters, const PocState& state, const PocEvent& event) {
  PocStep step = poc::answer(state.kind, event.kind)({parameters, state, event});
  // Stops timers and drops the schedule here, once for all transitions that leave them behind.
  if (runs_timers(state.kind) && !runs_timers(step.next.kind)) step.actions |= PocAction::kStopTimers;
  if (has_schedule(state.kind) && !has_schedule(step.next.kind)) step.actions |= PocAction::kDropSchedule;
  return step;
}

MacMode mac_mode(const PocState& state) {
  switch (state.kind) {
    case PocKind::kColdstartCollisionResolution:
    case PocKind::kColdstartConsistencyCheck:
    case PocKind::kColdstartJoin: return MacMode::kStartupFrame;
    case PocKind::kNormalActive: return state.slot_mode == SlotMode::kAll ? MacMode::kAll : MacMode::kKeySlot;
    case PocKind::kDefaultConfig:
    case PocKind::kConfig:
    case PocKind::kReady:
    case PocKind::kHalt:
    case PocKind::kWakeupListen:
    case PocKind::kWakeupSend:
    case PocKind::kWakeupDetect:
    case PocKind::kColdstartListen:
    case PocKind::kColdstartGap:
    case PocKind::kIntegrationListen:
    case PocKind::kInitialiseSchedule:
    case PocKind::kIntegrationColdstartCheck:
    case PocKind::kIntegrationConsistencyCheck:
    case PocKind::kNormalPassive: return MacMode::kNothing;
  }
  return MacMode::kNothing;
}

bool has_schedule(PocKind kind) {
  return kind == PocKind::kNormalActive || kind == PocKind::kNormalPassive ||
         (in_startup(kind) && kind != PocKind::kColdstartListen && kind != PocKind::kIntegrationListen);
}

bool listen_timer_follows_channels(PocKind kind) {
  return kind == PocKind::kWakeupListen || kind == PocKind::kColdstartListen;
}

bool corrects_clock(PocKind kind) {
  return has_schedule(kind) && kind != PocKind::kInitialiseSchedule && kind != PocKind::kColdstartCollisionResolution &&
         kind != PocKind::kColdstartGap;
}

}  // namespace ttf::bus::poc
