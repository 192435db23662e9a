#include "bus/poc.h"

#include "bus/poc_states.h"

namespace ttf::bus {
namespace {

PocStep step_in_state(const poc::Now& now) {
  switch (now.state.kind) {
    case PocKind::kDefaultConfig: return poc::in_default_config(now);
    case PocKind::kConfig: return poc::in_config(now);
    case PocKind::kReady: return poc::in_ready(now);
    case PocKind::kHalt: return poc::in_halt(now);
    case PocKind::kWakeupListen: return poc::in_wakeup_listen(now);
    case PocKind::kWakeupSend: return poc::in_wakeup_send(now);
    case PocKind::kWakeupDetect: return poc::in_wakeup_detect(now);
    case PocKind::kColdstartListen: return poc::in_coldstart_listen(now);
    case PocKind::kColdstartCollisionResolution: return poc::in_collision_resolution(now);
    case PocKind::kColdstartConsistencyCheck: return poc::in_consistency_check(now);
    case PocKind::kColdstartGap: return poc::in_gap(now);
    case PocKind::kIntegrationListen: return poc::in_integration_listen(now);
    case PocKind::kInitialiseSchedule: return poc::in_initialise_schedule(now);
    case PocKind::kIntegrationColdstartCheck: return poc::in_integration_coldstart_check(now);
    case PocKind::kColdstartJoin: return poc::in_join(now);
    case PocKind::kIntegrationConsistencyCheck: return poc::in_integration_consistency_check(now);
    case PocKind::kNormalActive: return poc::in_normal_active(now);
    case PocKind::kNormalPassive: return poc::in_normal_passive(now);
  }
  poc::unlisted(now);
}

bool runs_timers(PocKind kind) {
  return kind == PocKind::kWakeupListen || kind == PocKind::kWakeupDetect || kind == PocKind::kColdstartListen;
}

}  // namespace

PocParameters poc_parameters(const schedules::GlobalParameters& global, const schedules::NodeParameters& node) {
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
  PocStep step = step_in_state({parameters, state, event});
  // What is left behind with a state is put away here, once for all transitions.
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

bool in_startup(PocKind kind) {
  return kind >= PocKind::kColdstartListen && kind <= PocKind::kInitialiseSchedule;
}

bool has_schedule(PocKind kind) {
  return kind == PocKind::kNormalActive || kind == PocKind::kNormalPassive ||
         (in_startup(kind) && kind != PocKind::kColdstartListen && kind != PocKind::kIntegrationListen);
}

bool corrects_clock(PocKind kind) {
  return has_schedule(kind) && kind != PocKind::kInitialiseSchedule &&
         kind != PocKind::kColdstartCollisionResolution && kind != PocKind::kColdstartGap;
}

}  // namespace ttf::bus
