#include "schedules/check/constraints.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/int128.h"
#include "schedules/model/wire_times.h"

namespace ttf::schedules::check {
namespace {

using S = const Constrained&;
using On = Constraint::On;
using model::ceil_div;
using model::scaled;

constexpr Int128 kFast = model::kWhole + model::kDeviation, kSlow = model::kWhole - model::kDeviation;

// Returns microticks that last for at least that time on a fast clock.
std::int64_t microticks(S s, std::int64_t ps) { return ceil_div(scaled(ps), s.p.pdMicrotick_ps * kSlow); }

// Return bits of a slow sender on a fast receiver's clock, and the reverse.
std::int64_t longest(std::int64_t bits) { return ceil_div(bits * kFast, kSlow); }
std::int64_t shortest(std::int64_t half_bits) { return static_cast<std::int64_t>(half_bits * kSlow / (2 * kFast)); }

int cycle_sum(S s) {
  return s.g.gdStaticSlot * s.g.gNumberOfStaticSlots + action_point_difference(s.g) +
         s.g.gdMinislot * s.g.gNumberOfMinislots + s.g.gdSymbolWindow + s.g.gdNIT;
}
std::int64_t least_action_point(S s) {
  return ceil_div(std::max<std::int64_t>(assumed_precision_ps(s.g) - s.g.gdMinPropagationDelay_ps, 0),
                  s.g.gdMacrotick_ps);
}
std::int64_t least_minislot_action_point(S s) {
  return ceil_div(scaled(std::max<std::int64_t>(assumed_precision_ps(s.g) - s.g.gdMinPropagationDelay_ps, 0)),
                  shortest_macroticks(s.g, 1));
}
std::int64_t least_minislot(S s) {
  return s.g.gdMinislotActionPointOffset +
         ceil_div(scaled(assumed_precision_ps(s.g) + s.g.gdMaxPropagationDelay_ps), shortest_macroticks(s.g, 1));
}
// Receivers must see the channel idle before the next slot may begin.
std::int64_t least_idle_phase(S s) {
  const Int128 idle = longest_bits(s.g, model::kIdleDelimiterBits) +
                      scaled(assumed_precision_ps(s.g) + s.g.gdMaxPropagationDelay_ps) -
                      shortest_macroticks(s.g, s.g.gdMinislot - s.g.gdMinislotActionPointOffset);
  return idle <= 0 ? 0 : ceil_div(idle, shortest_macroticks(s.g, s.g.gdMinislot));
}
// Assumes the other node with the largest opposite drift; counted in own microticks.
std::int64_t least_rate_correction(S s) {
  return ceil_div(static_cast<Int128>(s.p.pMicroPerCycle) * (s.drift_ppb + s.others_drift_ppb),
                  1'000'000'000 - s.others_drift_ppb);
}
std::int64_t least_offset_correction(S s) { return ceil_div(assumed_precision_ps(s.g), s.p.pdMicrotick_ps); }
// Leaves a microtick to each macrotick after gOffsetCorrectionStart, in the shortest cycle after rate correction. Both
// corrections include their external terms.
std::int64_t most_offset_correction(S s) {
  const std::int64_t macroticks = s.g.gMacroPerCycle - s.g.gOffsetCorrectionStart;
  return macroticks * (s.p.pMicroPerCycle - s.p.pRateCorrectionOut - s.p.pExternRateCorrection) / s.g.gMacroPerCycle -
         macroticks - s.p.pExternOffsetCorrection;
}
std::int64_t listen_timeout(S s) {
  return 2 * (static_cast<std::int64_t>(s.p.pMicroPerCycle) + s.p.pRateCorrectionOut);
}
std::int64_t least_delay(S s) { return s.g.gdMinPropagationDelay_ps / s.p.pdMicrotick_ps; }
std::int64_t most_delay(S s) { return ceil_div(s.g.gdMaxPropagationDelay_ps, s.p.pdMicrotick_ps); }
bool is_a_delay(S s, std::int64_t delay) { return delay >= least_delay(s) && delay <= most_delay(s); }
std::string a_delay(S s) {
  return fmt::format("must be {}..{} microticks: from gdMinPropagationDelay to gdMaxPropagationDelay", least_delay(s),
                     most_delay(s));
}

std::int64_t least_cas(S s) { return longest(2 * (s.g.gdTSSTransmitter + model::kCasBits)); }
std::int64_t most_wakeup_low(S s) { return shortest(2 * s.g.gdWakeupSymbolTxLow); }
// Another pattern halves the idle phase, at worst.
std::int64_t most_wakeup_idle(S s) { return shortest(s.g.gdWakeupSymbolTxIdle - s.g.gdWakeupSymbolTxLow); }
std::int64_t least_wakeup_window(S s) { return longest(2 * s.g.gdWakeupSymbolTxLow + s.g.gdWakeupSymbolTxIdle); }
// The ranges of the two parameters end at these times in the longest and the shortest bit.
constexpr std::int64_t kWakeupLow_ps = 6'000'000, kWakeupIdle_ps = 18'000'000;
std::int64_t wakeup_low(S s) { return ceil_div(kWakeupLow_ps, s.g.gdBit_ps); }
std::int64_t wakeup_idle(S s) { return ceil_div(kWakeupIdle_ps, s.g.gdBit_ps); }

constexpr Constraint kConstraints[] = {
    {"cycle_sum", "gMacroPerCycle",
     "gMacroPerCycle = gdStaticSlot gNumberOfStaticSlots + adActionPointDifference + gdMinislot gNumberOfMinislots + "
     "gdSymbolWindow + gdNIT",
     On::kCluster, [](S s) { return cycle_sum(s) == s.g.gMacroPerCycle; },
     [](S s) { return number(s.g.gMacroPerCycle); },
     [](S s) {
       return fmt::format(
           "must be {} macroticks: {} slots x {} + {} (action point difference) + {} minislots x {} + "
           "symbol window {} + gdNIT {} (constraint 18)",
           cycle_sum(s), s.g.gNumberOfStaticSlots, s.g.gdStaticSlot, action_point_difference(s.g),
           s.g.gNumberOfMinislots, s.g.gdMinislot, s.g.gdSymbolWindow, s.g.gdNIT);
     }},
    {"cycle_length", "gdCycle", "gdCycle = gMacroPerCycle gdMacrotick", On::kCluster,
     [](S s) { return s.g.cycle_ps() == s.g.gdCycle_ps; }, [](S s) { return us(s.g.gdCycle_ps); },
     [](S s) { return fmt::format("must be gMacroPerCycle * gdMacrotick = {}", us(s.g.cycle_ps())); }},
    {"static_slot", "gdStaticSlot",
     "gdStaticSlot >= 2 gdActionPointOffset + (frame + idle delimiter + gdMinPropagationDelay + gdMaxPropagationDelay) "
     "/ "
     "(gdMacrotick (1 - cClockDeviationMax))",
     On::kCluster, [](S s) { return s.g.gdStaticSlot >= shortest_static_slot(s.g); },
     [](S s) { return number(s.g.gdStaticSlot); },
     [](S s) {
       return fmt::format("must be at least {} macroticks to hold a frame of {} words between its action points",
                          shortest_static_slot(s.g), s.g.gPayloadLengthStatic);
     }},
    {"action_point", "gdActionPointOffset",
     "gdActionPointOffset >= (gAssumedPrecision - gdMinPropagationDelay) / gdMacrotick", On::kCluster,
     [](S s) { return s.g.gdActionPointOffset >= least_action_point(s); },
     [](S s) { return number(s.g.gdActionPointOffset); },
     [](S s) {
       return fmt::format("must be at least {} macroticks: the assumed precision is {}", least_action_point(s),
                          us(assumed_precision_ps(s.g)));
     }},
    {"symbol_window", "gdSymbolWindow",
     "gdSymbolWindow = 0, or >= 2 gdActionPointOffset + (symbol + idle delimiter + dBDRxai + gdMinPropagationDelay + "
     "gdMaxPropagationDelay) / (gdMacrotick (1 - cClockDeviationMax))",
     On::kCluster, [](S s) { return s.g.gdSymbolWindow == 0 || s.g.gdSymbolWindow >= shortest_symbol_window(s.g); },
     [](S s) { return number(s.g.gdSymbolWindow); },
     [](S s) {
       return fmt::format("must be 0 (none) or at least {} macroticks (constraint 16)", shortest_symbol_window(s.g));
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
     [](S s) { return s.g.gdCASRxLowMax >= least_cas(s); }, [](S s) { return number(s.g.gdCASRxLowMax); },
     [](S s) {
       return fmt::format("must be at least {} bits: two collision avoidance symbols that overlap remain one",
                          least_cas(s));
     }},
    {"wakeup_low", "gdWakeupSymbolTxLow", "gdWakeupSymbolTxLow = 6 us / gdBit", On::kCluster,
     [](S s) { return s.g.gdWakeupSymbolTxLow == wakeup_low(s); }, [](S s) { return number(s.g.gdWakeupSymbolTxLow); },
     [](S s) { return fmt::format("must be {} bits, 6 us, with gdBit = {}", wakeup_low(s), us(s.g.gdBit_ps)); }},
    {"wakeup_idle", "gdWakeupSymbolTxIdle", "gdWakeupSymbolTxIdle = 18 us / gdBit", On::kCluster,
     [](S s) { return s.g.gdWakeupSymbolTxIdle == wakeup_idle(s); },
     [](S s) { return number(s.g.gdWakeupSymbolTxIdle); },
     [](S s) { return fmt::format("must be {} bits, 18 us, with gdBit = {}", wakeup_idle(s), us(s.g.gdBit_ps)); }},
    {"wakeup_heard_low", "gdWakeupSymbolRxLow",
     "gdWakeupSymbolRxLow <= gdWakeupSymbolTxLow (1 - cClockDeviationMax) / (1 + cClockDeviationMax)", On::kCluster,
     [](S s) { return s.g.gdWakeupSymbolRxLow <= most_wakeup_low(s); },
     [](S s) { return number(s.g.gdWakeupSymbolRxLow); },
     [](S s) {
       return fmt::format(
           "must be at most {} bits, the low phase of a slow receiver, sent with gdWakeupSymbolTxLow = {}",
           most_wakeup_low(s), s.g.gdWakeupSymbolTxLow);
     }},
    {"wakeup_heard_idle", "gdWakeupSymbolRxIdle",
     "gdWakeupSymbolRxIdle <= (gdWakeupSymbolTxIdle - gdWakeupSymbolTxLow) / 2 (1 - cClockDeviationMax) / (1 + "
     "cClockDeviationMax)",
     On::kCluster, [](S s) { return s.g.gdWakeupSymbolRxIdle <= most_wakeup_idle(s); },
     [](S s) { return number(s.g.gdWakeupSymbolRxIdle); },
     [](S s) {
       return fmt::format(
           "must be at most {} bits: so long is the bus idle at least where two wake-up patterns overlap",
           most_wakeup_idle(s));
     }},
    {"wakeup_window", "gdWakeupSymbolRxWindow",
     "gdWakeupSymbolRxWindow >= (2 gdWakeupSymbolTxLow + gdWakeupSymbolTxIdle) (1 + cClockDeviationMax) / (1 - "
     "cClockDeviationMax)",
     On::kCluster, [](S s) { return s.g.gdWakeupSymbolRxWindow >= least_wakeup_window(s); },
     [](S s) { return number(s.g.gdWakeupSymbolRxWindow); },
     [](S s) {
       return fmt::format("must be at least {} bits: two low phases and the idle one between them",
                          least_wakeup_window(s));
     }},

    {"minislot_action_point", "gdMinislotActionPointOffset",
     "gdMinislotActionPointOffset >= (gAssumedPrecision - gdMinPropagationDelay) / (gdMacrotick (1 - "
     "cClockDeviationMax))",
     On::kDynamicSegment, [](S s) { return s.g.gdMinislotActionPointOffset >= least_minislot_action_point(s); },
     [](S s) { return number(s.g.gdMinislotActionPointOffset); },
     [](S s) {
       return fmt::format("must be at least {} macroticks, the assumed precision, if the dynamic segment is used",
                          least_minislot_action_point(s));
     }},
    {"minislot", "gdMinislot",
     "gdMinislot >= gdMinislotActionPointOffset + (gAssumedPrecision + gdMaxPropagationDelay) / (gdMacrotick (1 - "
     "cClockDeviationMax))",
     On::kDynamicSegment, [](S s) { return s.g.gdMinislot >= least_minislot(s); },
     [](S s) { return number(s.g.gdMinislot); },
     [](S s) {
       return fmt::format(
           "must be at least {} macroticks if the dynamic segment is used: its action point, the longest "
           "propagation delay and the assumed precision",
           least_minislot(s));
     }},
    {"idle_phase", "gdDynamicSlotIdlePhase",
     "gdDynamicSlotIdlePhase gdMinislot >= idle delimiter + gAssumedPrecision + gdMaxPropagationDelay - (gdMinislot - "
     "gdMinislotActionPointOffset)",
     On::kDynamicSegment, [](S s) { return s.g.gdDynamicSlotIdlePhase >= least_idle_phase(s); },
     [](S s) { return number(s.g.gdDynamicSlotIdlePhase); },
     [](S s) {
       return fmt::format(
           "must be at least {} minislots if the dynamic segment is used: receivers must see the channel "
           "idle after a frame",
           least_idle_phase(s));
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
     On::kController, [](S s) { return s.p.pRateCorrectionOut >= least_rate_correction(s); },
     [](S s) { return number(s.p.pRateCorrectionOut); },
     [](S s) {
       return fmt::format("must be at least {} microticks to follow the worst drift between two nodes",
                          least_rate_correction(s));
     }},
    {"offset_correction", "pOffsetCorrectionOut",
     "gAssumedPrecision / pdMicrotick <= pOffsetCorrectionOut <= room after gOffsetCorrectionStart", On::kController,
     [](S s) {
       return s.p.pOffsetCorrectionOut >= least_offset_correction(s) &&
              s.p.pOffsetCorrectionOut <= most_offset_correction(s);
     },
     [](S s) { return number(s.p.pOffsetCorrectionOut); },
     [](S s) {
       return fmt::format(
           "must be {}..{} microticks: from the assumed precision to the room after gOffsetCorrectionStart at the "
           "fastest rate",
           least_offset_correction(s), most_offset_correction(s));
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
     [](S s) { return s.p.pdListenTimeout == listen_timeout(s); }, [](S s) { return number(s.p.pdListenTimeout); },
     [](S s) {
       return fmt::format(
           "must be {} microticks, 2 (pMicroPerCycle + pRateCorrectionOut): so long a node listens for a "
           "running cluster before it starts one",
           listen_timeout(s));
     }},
    {"accepted_startup_range", "pdAcceptedStartupRange",
     "pdAcceptedStartupRange >= gAssumedPrecision / (pdMicrotick (1 - cClockDeviationMax))", On::kController,
     [](S s) { return s.p.pdAcceptedStartupRange >= microticks(s, assumed_precision_ps(s.g)); },
     [](S s) { return number(s.p.pdAcceptedStartupRange); },
     [](S s) {
       return fmt::format(
           "must be at least {} microticks, the assumed precision of {}: later startup frames do not count",
           microticks(s, assumed_precision_ps(s.g)), us(assumed_precision_ps(s.g)));
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
