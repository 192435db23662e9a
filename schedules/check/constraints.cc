#include "schedules/check/constraints.h"

#include <fmt/format.h>

#include "core/int128.h"

namespace ttf::schedules::check {
namespace {

using S = const Constrained&;
using On = Constraint::On;

bool is_a_delay(S s, std::int64_t delay) {
  return delay >= analysis::least_delay(s) && delay <= analysis::most_delay(s);
}
std::string a_delay(S s) {
  return fmt::format("must be {}..{} microticks: from gdMinPropagationDelay to gdMaxPropagationDelay",
                     analysis::least_delay(s), analysis::most_delay(s));
}

constexpr Constraint kConstraints[] = {
    {"cycle_sum", "gMacroPerCycle",
     "gMacroPerCycle = gdStaticSlot gNumberOfStaticSlots + adActionPointDifference + gdMinislot gNumberOfMinislots + "
     "gdSymbolWindow + gdNIT",
     On::kCluster, [](S s) { return analysis::cycle_sum(s) == s.g.gMacroPerCycle; },
     [](S s) { return number(s.g.gMacroPerCycle); },
     [](S s) {
       return fmt::format(
           "must be {} macroticks: {} slots x {} + {} (action point difference) + {} minislots x {} + "
           "symbol window {} + gdNIT {} (constraint 18)",
           analysis::cycle_sum(s), s.g.gNumberOfStaticSlots, s.g.gdStaticSlot, action_point_difference(s.g),
           s.g.gNumberOfMinislots, s.g.gdMinislot, s.g.gdSymbolWindow, s.g.gdNIT);
     }},
    {"cycle_length", "gdCycle", "gdCycle = gMacroPerCycle gdMacrotick", On::kCluster,
     [](S s) { return s.g.cycle_ps() == s.g.gdCycle_ps; }, [](S s) { return us(s.g.gdCycle_ps); },
     [](S s) { return fmt::format("must be gMacroPerCycle * gdMacrotick = {}", us(s.g.cycle_ps())); }},
    {"static_slot", "gdStaticSlot",
     "gdStaticSlot >= 2 gdActionPointOffset + (frame + idle delimiter + gdMinPropagationDelay + gdMaxPropagationDelay) "
     "/ "
     "(gdMacrotick (1 - cClockDeviationMax))",
     On::kCluster, [](S s) { return s.g.gdStaticSlot >= analysis::shortest_static_slot(s.g); },
     [](S s) { return number(s.g.gdStaticSlot); },
     [](S s) {
       return fmt::format("must be at least {} macroticks to hold a frame of {} words between its action points",
                          analysis::shortest_static_slot(s.g), s.g.gPayloadLengthStatic);
     }},
    {"action_point", "gdActionPointOffset",
     "gdActionPointOffset >= (gAssumedPrecision - gdMinPropagationDelay) / gdMacrotick", On::kCluster,
     [](S s) { return s.g.gdActionPointOffset >= analysis::least_action_point(s); },
     [](S s) { return number(s.g.gdActionPointOffset); },
     [](S s) {
       return fmt::format("must be at least {} macroticks: the assumed precision is {}",
                          analysis::least_action_point(s), us(assumed_precision_ps(s.g)));
     }},
    {"symbol_window", "gdSymbolWindow",
     "gdSymbolWindow = 0, or >= 2 gdActionPointOffset + (symbol + idle delimiter + dBDRxai + gdMinPropagationDelay + "
     "gdMaxPropagationDelay) / (gdMacrotick (1 - cClockDeviationMax))",
     On::kCluster,
     [](S s) { return s.g.gdSymbolWindow == 0 || s.g.gdSymbolWindow >= analysis::shortest_symbol_window(s.g); },
     [](S s) { return number(s.g.gdSymbolWindow); },
     [](S s) {
       return fmt::format("must be 0 (none) or at least {} macroticks (constraint 16)",
                          analysis::shortest_symbol_window(s.g));
     }},
    {"offset_correction_start", "gOffsetCorrectionStart",
     "gMacroPerCycle - gdNIT <= gOffsetCorrectionStart < gMacroPerCycle", On::kCluster,
     [](S s) {
       return s.g.gOffsetCorrectionStart >= s.g.gMacroPerCycle - s.g.gdNIT &&
              s.g.gOffsetCorrectionStart < s.g.gMacroPerCycle;
     },
     [](S s) { return number(s.g.gOffsetCorrectionStart); },
     [](S s) {
       return fmt::format("must lie in the network idle time, {}..{} macroticks", s.g.gMacroPerCycle - s.g.gdNIT,
                          s.g.gMacroPerCycle - 1);
     }},
    {"fatal_after_passive", "gMaxWithoutClockCorrectionFatal",
     "gMaxWithoutClockCorrectionFatal >= gMaxWithoutClockCorrectionPassive", On::kCluster,
     [](S s) { return s.g.gMaxWithoutClockCorrectionFatal >= s.g.gMaxWithoutClockCorrectionPassive; },
     [](S s) { return number(s.g.gMaxWithoutClockCorrectionFatal); },
     [](S s) {
       return fmt::format("must be {}..15: not below gMaxWithoutClockCorrectionPassive",
                          s.g.gMaxWithoutClockCorrectionPassive);
     }},
    {"cas_length", "gdCASRxLowMax",
     "gdCASRxLowMax >= 2 (gdTSSTransmitter + cdCAS) (1 + cClockDeviationMax) / (1 - cClockDeviationMax)", On::kCluster,
     [](S s) { return s.g.gdCASRxLowMax >= analysis::least_cas(s); }, [](S s) { return number(s.g.gdCASRxLowMax); },
     [](S s) {
       return fmt::format("must be at least {} bits: two collision avoidance symbols that overlap remain one",
                          analysis::least_cas(s));
     }},
    {"wakeup_low", "gdWakeupSymbolTxLow", "gdWakeupSymbolTxLow = 6 us / gdBit", On::kCluster,
     [](S s) { return s.g.gdWakeupSymbolTxLow == analysis::wakeup_low(s); },
     [](S s) { return number(s.g.gdWakeupSymbolTxLow); },
     [](S s) {
       return fmt::format("must be {} bits, 6 us, with gdBit = {}", analysis::wakeup_low(s), us(s.g.gdBit_ps));
     }},
    {"wakeup_idle", "gdWakeupSymbolTxIdle", "gdWakeupSymbolTxIdle = 18 us / gdBit", On::kCluster,
     [](S s) { return s.g.gdWakeupSymbolTxIdle == analysis::wakeup_idle(s); },
     [](S s) { return number(s.g.gdWakeupSymbolTxIdle); },
     [](S s) {
       return fmt::format("must be {} bits, 18 us, with gdBit = {}", analysis::wakeup_idle(s), us(s.g.gdBit_ps));
     }},
    {"wakeup_heard_low", "gdWakeupSymbolRxLow",
     "gdWakeupSymbolRxLow <= gdWakeupSymbolTxLow (1 - cClockDeviationMax) / (1 + cClockDeviationMax)", On::kCluster,
     [](S s) { return s.g.gdWakeupSymbolRxLow <= analysis::most_wakeup_low(s); },
     [](S s) { return number(s.g.gdWakeupSymbolRxLow); },
     [](S s) {
       return fmt::format(
           "must be at most {} bits, the low phase of a slow receiver, sent with gdWakeupSymbolTxLow = {}",
           analysis::most_wakeup_low(s), s.g.gdWakeupSymbolTxLow);
     }},
    {"wakeup_heard_idle", "gdWakeupSymbolRxIdle",
     "gdWakeupSymbolRxIdle <= (gdWakeupSymbolTxIdle - gdWakeupSymbolTxLow) / 2 (1 - cClockDeviationMax) / (1 + "
     "cClockDeviationMax)",
     On::kCluster, [](S s) { return s.g.gdWakeupSymbolRxIdle <= analysis::most_wakeup_idle(s); },
     [](S s) { return number(s.g.gdWakeupSymbolRxIdle); },
     [](S s) {
       return fmt::format(
           "must be at most {} bits: so long is the bus idle at least where two wake-up patterns overlap",
           analysis::most_wakeup_idle(s));
     }},
    {"wakeup_window", "gdWakeupSymbolRxWindow",
     "gdWakeupSymbolRxWindow >= (2 gdWakeupSymbolTxLow + gdWakeupSymbolTxIdle) (1 + cClockDeviationMax) / (1 - "
     "cClockDeviationMax)",
     On::kCluster, [](S s) { return s.g.gdWakeupSymbolRxWindow >= analysis::least_wakeup_window(s); },
     [](S s) { return number(s.g.gdWakeupSymbolRxWindow); },
     [](S s) {
       return fmt::format("must be at least {} bits: two low phases and the idle one between them",
                          analysis::least_wakeup_window(s));
     }},

    {"minislot_action_point", "gdMinislotActionPointOffset",
     "gdMinislotActionPointOffset >= (gAssumedPrecision - gdMinPropagationDelay) / (gdMacrotick (1 - "
     "cClockDeviationMax))",
     On::kDynamicSegment,
     [](S s) { return s.g.gdMinislotActionPointOffset >= analysis::least_minislot_action_point(s); },
     [](S s) { return number(s.g.gdMinislotActionPointOffset); },
     [](S s) {
       return fmt::format("must be at least {} macroticks, the assumed precision, if the dynamic segment is used",
                          analysis::least_minislot_action_point(s));
     }},
    {"minislot", "gdMinislot",
     "gdMinislot >= gdMinislotActionPointOffset + (gAssumedPrecision + gdMaxPropagationDelay) / (gdMacrotick (1 - "
     "cClockDeviationMax))",
     On::kDynamicSegment, [](S s) { return s.g.gdMinislot >= analysis::least_minislot(s); },
     [](S s) { return number(s.g.gdMinislot); },
     [](S s) {
       return fmt::format(
           "must be at least {} macroticks if the dynamic segment is used: its action point, the longest "
           "propagation delay and the assumed precision",
           analysis::least_minislot(s));
     }},
    {"idle_phase", "gdDynamicSlotIdlePhase",
     "gdDynamicSlotIdlePhase gdMinislot >= idle delimiter + gAssumedPrecision + gdMaxPropagationDelay - (gdMinislot - "
     "gdMinislotActionPointOffset)",
     On::kDynamicSegment, [](S s) { return s.g.gdDynamicSlotIdlePhase >= analysis::least_idle_phase(s); },
     [](S s) { return number(s.g.gdDynamicSlotIdlePhase); },
     [](S s) {
       return fmt::format(
           "must be at least {} minislots if the dynamic segment is used: receivers must see the channel "
           "idle after a frame",
           analysis::least_idle_phase(s));
     }},

    {"microticks_per_cycle", "pMicroPerCycle", "pMicroPerCycle = gdCycle / pdMicrotick", On::kController,
     [](S s) { return static_cast<Int128>(s.p.pMicroPerCycle) * s.p.pdMicrotick_ps == s.g.gdCycle_ps; },
     [](S s) { return number(s.p.pMicroPerCycle); },
     [](S s) {
       return fmt::format("must make gdCycle = {} out of microticks of {}", us(s.g.gdCycle_ps), ns(s.p.pdMicrotick_ps));
     }},
    {"longest_microtick", "pdMicrotick", "pdMicrotick <= gdMaxMicrotick", On::kController,
     [](S s) { return s.p.pdMicrotick_ps <= s.g.gdMaxMicrotick_ps; }, [](S s) { return ns(s.p.pdMicrotick_ps); },
     [](S s) { return fmt::format("must be at most gdMaxMicrotick = {}", ns(s.g.gdMaxMicrotick_ps)); }},
    {"rate_correction", "pRateCorrectionOut",
     "pRateCorrectionOut >= pMicroPerCycle (drift + worst drift of another) / (1 - worst drift of another)",
     On::kController, [](S s) { return s.p.pRateCorrectionOut >= analysis::least_rate_correction(s); },
     [](S s) { return number(s.p.pRateCorrectionOut); },
     [](S s) {
       return fmt::format("must be at least {} microticks to follow the worst drift between two nodes",
                          analysis::least_rate_correction(s));
     }},
    {"offset_correction", "pOffsetCorrectionOut",
     "gAssumedPrecision / pdMicrotick <= pOffsetCorrectionOut <= room after gOffsetCorrectionStart", On::kController,
     [](S s) {
       return s.p.pOffsetCorrectionOut >= analysis::least_offset_correction(s) &&
              s.p.pOffsetCorrectionOut <= analysis::most_offset_correction(s);
     },
     [](S s) { return number(s.p.pOffsetCorrectionOut); },
     [](S s) {
       return fmt::format(
           "must be {}..{} microticks: from the assumed precision to the module after gOffsetCorrectionStart at the "
           "fastest rate",
           analysis::least_offset_correction(s), analysis::most_offset_correction(s));
     }},
    {"drift_damping", "pClusterDriftDamping", "pClusterDriftDamping pdMicrotick <= gClusterDriftDamping gdMaxMicrotick",
     On::kController,
     [](S s) {
       return static_cast<std::int64_t>(s.p.pClusterDriftDamping) * s.p.pdMicrotick_ps <=
              static_cast<std::int64_t>(s.g.gClusterDriftDamping) * s.g.gdMaxMicrotick_ps;
     },
     [](S s) { return number(s.p.pClusterDriftDamping); },
     [](S s) {
       return fmt::format("must not exceed gClusterDriftDamping = {} longest microticks", s.g.gClusterDriftDamping);
     }},
    {"listen_timeout", "pdListenTimeout", "pdListenTimeout = 2 (pMicroPerCycle + pRateCorrectionOut)", On::kController,
     [](S s) { return s.p.pdListenTimeout == analysis::listen_timeout(s); },
     [](S s) { return number(s.p.pdListenTimeout); },
     [](S s) {
       return fmt::format(
           "must be {} microticks, 2 (pMicroPerCycle + pRateCorrectionOut): so long a node listens for a "
           "running cluster before it starts one",
           analysis::listen_timeout(s));
     }},
    {"accepted_startup_range", "pdAcceptedStartupRange",
     "pdAcceptedStartupRange >= gAssumedPrecision / (pdMicrotick (1 - cClockDeviationMax))", On::kController,
     [](S s) { return s.p.pdAcceptedStartupRange >= analysis::least_startup_range(s); },
     [](S s) { return number(s.p.pdAcceptedStartupRange); },
     [](S s) {
       return fmt::format(
           "must be at least {} microticks, the assumed precision of {}: later startup frames do not count",
           analysis::least_startup_range(s), us(assumed_precision_ps(s.g)));
     }},
    {"delay_compensation_a", "pDelayCompensationA",
     "gdMinPropagationDelay <= pDelayCompensation[A] pdMicrotick <= gdMaxPropagationDelay", On::kController,
     [](S s) { return is_a_delay(s, s.p.pDelayCompensationA); }, [](S s) { return number(s.p.pDelayCompensationA); },
     a_delay},
    {"delay_compensation_b", "pDelayCompensationB",
     "gdMinPropagationDelay <= pDelayCompensation[B] pdMicrotick <= gdMaxPropagationDelay", On::kController,
     [](S s) { return is_a_delay(s, s.p.pDelayCompensationB); }, [](S s) { return number(s.p.pDelayCompensationB); },
     a_delay},
};

}  // namespace

std::span<const Constraint> constraints() { return kConstraints; }

void check_constraints(Constraint::On on, const Constrained& subject, const std::string& path,
                       ClusterFindings& findings) {
  for (const Constraint& one : kConstraints)
    if (one.on == on && !one.holds(subject))
      findings.parameter(path + one.parameter, one.value(subject), one.sentence(subject));
}

}  // namespace ttf::schedules::check
