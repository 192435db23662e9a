#include "schedules/file/derive.h"

#include <algorithm>
#include <limits>

#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/minislots.h"

namespace ttf::schedules::file {
namespace {

using Value = std::optional<std::int64_t>;
using G = const model::GlobalParameters&;
using A = const Absent&;
using C = const Controller&;

constexpr model::NodeParameters kNone{};
constexpr analysis::Terms of(G g) { return {g, kNone}; }

Value quotient(Int128 whole, Int128 part) {
  if (part <= 0 || whole % part != 0) return std::nullopt;
  return static_cast<std::int64_t>(whole / part);
}
Value if_known(A absent, std::string_view parameter, Value value) {
  return absent.contains(parameter) ? std::nullopt : value;
}

constexpr Int128 kBitPs = 1'000'000'000'000;  // gdBit in picoseconds times baudrate

constexpr GlobalRule kGlobalRules[] = {
    {"baudrate", "1 / gdBit", [](G g, A a) { return if_known(a, "gdBit", quotient(kBitPs, g.gdBit_ps)); }},
    {"gdBit", "1 / baudrate", [](G g, A a) { return if_known(a, "baudrate", quotient(kBitPs, g.baudrate)); }},
    {"gCycleCountMax", "63, the only one in 2.1", [](G, A) { return Value(63); }},
    {"gdWakeupSymbolTxLow", "6 us / gdBit (40)", [](G g, A) { return Value(analysis::wakeup_low(of(g))); }},
    {"gdWakeupSymbolTxIdle", "18 us / gdBit (39)", [](G g, A) { return Value(analysis::wakeup_idle(of(g))); }},
    {"gdWakeupSymbolRxIdle", "the most of `wakeup_heard_idle`",
     [](G g, A) { return Value(analysis::most_wakeup_idle(of(g))); }},
    {"gdWakeupSymbolRxWindow", "the least of `wakeup_window`",
     [](G g, A) { return Value(analysis::least_wakeup_window(of(g))); }},
    {"gdCASRxLowMax", "the least of `cas_length`", [](G g, A) { return Value(analysis::least_cas(of(g))); }},
    {"gdMacrotick", "gdCycle / gMacroPerCycle",
     [](G g, A a) {
       return if_known(a, "gdCycle", if_known(a, "gMacroPerCycle", quotient(g.gdCycle_ps, g.gMacroPerCycle)));
     }},
    {"gdActionPointOffset", "the least of `action_point`",
     [](G g, A) { return Value(std::max<std::int64_t>(analysis::least_action_point(of(g)), 1)); }},
    {"gdStaticSlot", "the least of `static_slot`", [](G g, A) { return Value(analysis::shortest_static_slot(g)); }},
    {"gdMinislotActionPointOffset", "the least of `minislot_action_point`",
     [](G g, A) { return Value(std::max<std::int64_t>(analysis::least_minislot_action_point(of(g)), 1)); }},
    {"gdMinislot", "the least of `minislot`",
     [](G g, A) { return Value(std::max<std::int64_t>(analysis::least_minislot(of(g)), 2)); }},
    {"gdDynamicSlotIdlePhase", "the least of `idle_phase`",
     [](G g, A) { return Value(analysis::least_idle_phase(of(g))); }},
    {"gMacroPerCycle", "gdCycle / gdMacrotick, or without gdCycle the sum of the segments (18)",
     [](G g, A a) {
       if (!a.contains("gdCycle")) return quotient(g.gdCycle_ps, g.gdMacrotick_ps);
       return if_known(a, "gdNIT", analysis::cycle_sum(of(g)));
     }},
    {"gdCycle", "gMacroPerCycle gdMacrotick (17)", [](G g, A) { return Value(g.cycle_ps()); }},
    {"gdNIT", "the rest of the cycle (18)", [](G g, A) { return Value(g.gMacroPerCycle - analysis::segments_sum(g)); }},
    {"gOffsetCorrectionStart", "gMacroPerCycle - gdNIT: the least of `offset_correction_start`",
     [](G g, A) { return Value(g.gMacroPerCycle - g.gdNIT); }},
};

constexpr NodeRule kClockRules[] = {
    {"pdMicrotick", "pSamplesPerMicrotick gdBit / 8",
     [](C c, A a) {
       return if_known(a, "pSamplesPerMicrotick",
                       quotient(Int128{c.terms.p.pSamplesPerMicrotick} * c.terms.g.gdBit_ps, model::kSamplesPerBit));
     }},
    {"pSamplesPerMicrotick", "8 pdMicrotick / gdBit",
     [](C c, A a) {
       return if_known(a, "pdMicrotick",
                       quotient(Int128{model::kSamplesPerBit} * c.terms.p.pdMicrotick_ps, c.terms.g.gdBit_ps));
     }},
};

// A delay within its bounds, as far from both as can be.
Value middle_delay(C c) { return (analysis::least_delay(c.terms) + analysis::most_delay(c.terms)) / 2; }

// cdFSS and half of cdBSS in bits, cStrobeOffset and cVotingDelay in samples (annex A).
constexpr std::int64_t kStartBits = 2, kStrobeOffset = 5, kVotingDelay = 2;
Value decoding_correction(C c) {
  const std::int64_t samples =
      (c.terms.g.gdTSSTransmitter + kStartBits) * model::kSamplesPerBit + kStrobeOffset + kVotingDelay;
  return (2 * samples + c.terms.p.pSamplesPerMicrotick) / (2 * c.terms.p.pSamplesPerMicrotick);  // rounded
}

// Decoding correction and delay compensation, in macroticks and the microticks that they leave of the last one.
std::int64_t integration_ps(C c, int delay) {
  return (std::int64_t{c.terms.p.pDecodingCorrection} + delay) * c.terms.p.pdMicrotick_ps;
}
Value macro_offset(C c, int delay) {
  return c.terms.g.gdActionPointOffset + model::ceil_div(integration_ps(c, delay), c.terms.g.gdMacrotick_ps);
}
Value micro_offset(C c, int delay, int macro) {
  const std::int64_t macros = macro - c.terms.g.gdActionPointOffset;
  return (macros * c.terms.g.gdMacrotick_ps - integration_ps(c, delay)) / c.terms.p.pdMicrotick_ps;
}

// The last minislot in which the node's longest dynamic frame may begin.
Value latest_start(C c) {
  const auto sends = [&](const model::FrameSlot& frame) {
    return frame.sender == c.id && is_dynamic(c.terms.g, frame);
  };
  if (std::none_of(c.cluster.frames.begin(), c.cluster.frames.end(), sends)) return c.terms.g.gNumberOfMinislots;
  return analysis::last_start(c.terms.g, analysis::longest_dynamic_words(c.cluster, c.id));
}

// The first static slot that the node has in every cycle on all its channels: one of a status frame, or else any.
Value key_slot(C c) {
  const auto own = [&](const model::FrameSlot& frame) {
    return frame.sender == c.id && frame.repetition == 1 && frame.channels == c.terms.p.pChannels &&
           !is_dynamic(c.terms.g, frame);
  };
  for (const bool status : {true, false})
    for (const model::FrameSlot& frame : c.cluster.frames)
      if (own(frame) && (!status || frame.pdu == kNoPdu)) return frame.slot;
  return std::nullopt;
}

constexpr NodeRule kNodeRules[] = {
    {"pMicroPerCycle", "gdCycle / pdMicrotick (19)",
     [](C c, A) { return quotient(c.terms.g.gdCycle_ps, c.terms.p.pdMicrotick_ps); }},
    {"pRateCorrectionOut", "the least of `rate_correction`",
     [](C c, A) { return Value(std::max<std::int64_t>(analysis::least_rate_correction(c.terms), 2)); }},
    {"pOffsetCorrectionOut", "the least of `offset_correction`",
     [](C c, A) { return Value(std::max<std::int64_t>(analysis::least_offset_correction(c.terms), 5)); }},
    {"pdListenTimeout", "2 (pMicroPerCycle + pRateCorrectionOut) (31)",
     [](C c, A) { return Value(analysis::listen_timeout(c.terms)); }},
    {"pdAcceptedStartupRange", "the least of `accepted_startup_range`",
     [](C c, A) { return Value(analysis::least_startup_range(c.terms)); }},
    {"pDelayCompensationA", "the middle of `delay_compensation_a`", [](C c, A) { return middle_delay(c); }},
    {"pDelayCompensationB", "the middle of `delay_compensation_b`", [](C c, A) { return middle_delay(c); }},
    {"pDecodingCorrection",
     "((gdTSSTransmitter + cdFSS + cdBSS / 2) cSamplesPerBit + cStrobeOffset + cVotingDelay) / "
     "pSamplesPerMicrotick, rounded (32)",
     [](C c, A) { return decoding_correction(c); }},
    {"pMacroInitialOffsetA",
     "gdActionPointOffset + (pDecodingCorrection + pDelayCompensation[A]) in macroticks, rounded up",
     [](C c, A) { return macro_offset(c, c.terms.p.pDelayCompensationA); }},
    {"pMacroInitialOffsetB",
     "gdActionPointOffset + (pDecodingCorrection + pDelayCompensation[B]) in macroticks, rounded up",
     [](C c, A) { return macro_offset(c, c.terms.p.pDelayCompensationB); }},
    {"pMicroInitialOffsetA", "what pDecodingCorrection + pDelayCompensation[A] leave of these macroticks",
     [](C c, A) { return micro_offset(c, c.terms.p.pDelayCompensationA, c.terms.p.pMacroInitialOffsetA); }},
    {"pMicroInitialOffsetB", "what pDecodingCorrection + pDelayCompensation[B] leave of these macroticks",
     [](C c, A) { return micro_offset(c, c.terms.p.pDelayCompensationB, c.terms.p.pMacroInitialOffsetB); }},
    {"pLatestTx", "the last minislot for the node's longest dynamic frame; gNumberOfMinislots without one",
     [](C c, A) { return latest_start(c); }},
    {"pKeySlotId", "the first slot that the node has in every cycle: of a status frame, or else of any",
     [](C c, A) { return key_slot(c); }},
};

template <class Rules> bool has_rule(const Rules& rules, std::string_view parameter) {
  return std::any_of(rules.begin(), rules.end(), [&](const auto& rule) { return rule.parameter == parameter; });
}

}  // namespace

std::span<const GlobalRule> global_rules() { return kGlobalRules; }
std::span<const NodeRule> clock_rules() { return kClockRules; }
std::span<const NodeRule> node_rules() { return kNodeRules; }

bool is_derived(std::string_view parameter) {
  return has_rule(global_rules(), parameter) || has_rule(clock_rules(), parameter) || has_rule(node_rules(), parameter);
}

}  // namespace ttf::schedules::file
