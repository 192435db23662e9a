// The bounds and equations of FlexRay 2.1A, annex B.4, in numbers: what a parameter must be, or its least or largest
// value. schedules/check/constraints.cc holds a cluster against them, schedules/file/derive.cc derives from them what a
// file leaves out. docs/schedules/flexray_constraints.md has their derivations.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/int128.h"
#include "schedules/model/flexray_parameters.h"
#include "schedules/model/wire_times.h"

namespace ttf::schedules::analysis {

// A cluster's parameters and those of one controller.
struct Terms {
  const model::GlobalParameters& g;
  const model::NodeParameters& p;     // defaults where a bound is on the cluster
  std::int64_t drift_ppb = 0;         // the largest of this node's clock
  std::int64_t others_drift_ppb = 0;  // and of any controller's
};

inline constexpr Int128 kFast = model::kWhole + model::kDeviation, kSlow = model::kWhole - model::kDeviation;

// A bus driver's longest reaction from idle to activity (electrical physical layer 2.1A, dBDRxai).
inline constexpr std::int64_t kDriverReaction_ps = 400'000;

// Returns microticks that last for at least that time on a fast clock.
constexpr std::int64_t microticks(const Terms& s, std::int64_t ps) {
  return model::ceil_div(model::scaled(ps), s.p.pdMicrotick_ps * kSlow);
}

// Return bits of a slow sender on a fast receiver's clock, and the reverse.
constexpr std::int64_t longest(std::int64_t bits) { return model::ceil_div(bits * kFast, kSlow); }
constexpr std::int64_t shortest(std::int64_t half_bits) {
  return static_cast<std::int64_t>(half_bits * kSlow / (2 * kFast));
}

// 2 gdActionPointOffset + ceil((bits gdBitMax + delays) / (gdMacrotick (1 - cClockDeviationMax))).
constexpr std::int64_t around_action_points(const model::GlobalParameters& g, std::int64_t bits,
                                            std::int64_t extra_ps) {
  const Int128 time =
      model::longest_bits(g, bits) + model::scaled(g.gdMinPropagationDelay_ps + g.gdMaxPropagationDelay_ps + extra_ps);
  return 2 * g.gdActionPointOffset + model::ceil_div(time, model::shortest_macroticks(g, 1));
}
// Return the shortest static slot for a frame of gPayloadLengthStatic words, and the shortest symbol window (constraint
// 16), in macroticks.
constexpr std::int64_t shortest_static_slot(const model::GlobalParameters& g) {
  return around_action_points(g, model::frame_bits(g, g.gPayloadLengthStatic) + model::kIdleDelimiterBits, 0);
}
constexpr std::int64_t shortest_symbol_window(const model::GlobalParameters& g) {
  return around_action_points(g, g.gdTSSTransmitter + model::kCasBits + model::kIdleDelimiterBits, kDriverReaction_ps);
}

// Constraint 18: the macroticks of all segments but the network idle time, and of all.
constexpr int segments_sum(const model::GlobalParameters& g) {
  return g.gdStaticSlot * g.gNumberOfStaticSlots + model::action_point_difference(g) +
         g.gdMinislot * g.gNumberOfMinislots + g.gdSymbolWindow;
}
constexpr int cycle_sum(const Terms& s) { return segments_sum(s.g) + s.g.gdNIT; }

constexpr std::int64_t least_action_point(const Terms& s) {
  return model::ceil_div(std::max<std::int64_t>(model::assumed_precision_ps(s.g) - s.g.gdMinPropagationDelay_ps, 0),
                         s.g.gdMacrotick_ps);
}
constexpr std::int64_t least_minislot_action_point(const Terms& s) {
  return model::ceil_div(
      model::scaled(std::max<std::int64_t>(model::assumed_precision_ps(s.g) - s.g.gdMinPropagationDelay_ps, 0)),
      model::shortest_macroticks(s.g, 1));
}
constexpr std::int64_t least_minislot(const Terms& s) {
  return s.g.gdMinislotActionPointOffset +
         model::ceil_div(model::scaled(model::assumed_precision_ps(s.g) + s.g.gdMaxPropagationDelay_ps),
                         model::shortest_macroticks(s.g, 1));
}
// Receivers must see the channel idle before the next slot may begin.
constexpr std::int64_t least_idle_phase(const Terms& s) {
  const Int128 idle = model::longest_bits(s.g, model::kIdleDelimiterBits) +
                      model::scaled(model::assumed_precision_ps(s.g) + s.g.gdMaxPropagationDelay_ps) -
                      model::shortest_macroticks(s.g, s.g.gdMinislot - s.g.gdMinislotActionPointOffset);
  return idle <= 0 ? 0 : model::ceil_div(idle, model::shortest_macroticks(s.g, s.g.gdMinislot));
}

// Assumes the other node with the largest opposite drift; counted in own microticks.
constexpr std::int64_t least_rate_correction(const Terms& s) {
  return model::ceil_div(static_cast<Int128>(s.p.pMicroPerCycle) * (s.drift_ppb + s.others_drift_ppb),
                         1'000'000'000 - s.others_drift_ppb);
}
constexpr std::int64_t least_offset_correction(const Terms& s) {
  return model::ceil_div(model::assumed_precision_ps(s.g), s.p.pdMicrotick_ps);
}
// Leaves a microtick to each macrotick after gOffsetCorrectionStart, in the shortest cycle after rate correction. Both
// corrections include their external terms.
constexpr std::int64_t most_offset_correction(const Terms& s) {
  const std::int64_t macroticks = s.g.gMacroPerCycle - s.g.gOffsetCorrectionStart;
  return macroticks * (s.p.pMicroPerCycle - s.p.pRateCorrectionOut - s.p.pExternRateCorrection) / s.g.gMacroPerCycle -
         macroticks - s.p.pExternOffsetCorrection;
}
constexpr std::int64_t listen_timeout(const Terms& s) {
  return 2 * (static_cast<std::int64_t>(s.p.pMicroPerCycle) + s.p.pRateCorrectionOut);
}
constexpr std::int64_t least_startup_range(const Terms& s) { return microticks(s, model::assumed_precision_ps(s.g)); }
constexpr std::int64_t least_delay(const Terms& s) { return s.g.gdMinPropagationDelay_ps / s.p.pdMicrotick_ps; }
constexpr std::int64_t most_delay(const Terms& s) {
  return model::ceil_div(s.g.gdMaxPropagationDelay_ps, s.p.pdMicrotick_ps);
}

constexpr std::int64_t least_cas(const Terms& s) { return longest(2 * (s.g.gdTSSTransmitter + model::kCasBits)); }
constexpr std::int64_t most_wakeup_low(const Terms& s) { return shortest(2 * s.g.gdWakeupSymbolTxLow); }
// Another pattern halves the idle phase, at worst.
constexpr std::int64_t most_wakeup_idle(const Terms& s) {
  return shortest(s.g.gdWakeupSymbolTxIdle - s.g.gdWakeupSymbolTxLow);
}
constexpr std::int64_t least_wakeup_window(const Terms& s) {
  return longest(2 * s.g.gdWakeupSymbolTxLow + s.g.gdWakeupSymbolTxIdle);
}
// The ranges of the two parameters end at these times in the longest and the shortest bit.
constexpr std::int64_t wakeup_low(const Terms& s) { return model::ceil_div(6'000'000, s.g.gdBit_ps); }
constexpr std::int64_t wakeup_idle(const Terms& s) { return model::ceil_div(18'000'000, s.g.gdBit_ps); }

}  // namespace ttf::schedules::analysis
