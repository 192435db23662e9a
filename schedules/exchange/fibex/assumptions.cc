#include "schedules/exchange/fibex/assumptions.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/decimal.h"
#include "schedules/exchange/fibex/parameters.h"
#include "schedules/file/parameter_table.h"
#include "schedules/model/wire_times.h"

namespace ttf::schedules::exchange::fibex {
namespace {

constexpr std::int64_t kPicosecondsPerSecond = 1'000'000'000'000;

// Sets the parameter to the legal value closest to `value`.
template <class Parameters, class Table>
void set_next_to(Parameters& parameters, const Table& table, std::string_view name, std::int64_t value) {
  for (const auto& p : table)
    if (p.name == name) parameters.*p.member = static_cast<int>(std::clamp<std::int64_t>(value, p.low, p.high));
}

}  // namespace

void assume_global(FibexFile& file, const std::string& name, std::set<std::string, std::less<>>& assumed,
                   Findings& wrong) {
  model::GlobalParameters& g = file.global;
  const auto given = [&](std::string_view parameter) { return file.given.find(parameter) != file.given.end(); };
  const auto missing = [&](std::string what) {
    wrong.add({name, file.cluster_line, "fx:CLUSTER", "", "must have " + std::move(what)});
  };
  for (const FibexParameter& one : kFibexCluster)
    if ((one.name == "gdStaticSlot" || one.name == "gNumberOfStaticSlots" || one.name == "gPayloadLengthStatic") &&
        !given(one.name))
      missing(fmt::format("a {} ({})", one.element, one.name));
  if (!given("baudrate")) missing("a fx:SPEED (baudrate)");
  const int of_three = given("gdCycle") + given("gdMacrotick") + given("gMacroPerCycle");
  if (of_three < 2) {
    missing("two of flexray:CYCLE, flexray:MACROTICK and flexray:MACRO-PER-CYCLE");
    return;
  }
  if (!given("gdCycle")) g.gdCycle_ps = g.cycle_ps();
  if (!given("gdMacrotick")) g.gdMacrotick_ps = g.gdCycle_ps / g.gMacroPerCycle;
  if (!given("gMacroPerCycle"))
    set_next_to(g, file::kGlobalIntegers, "gMacroPerCycle", g.gdCycle_ps / g.gdMacrotick_ps);
  if (of_three < 3 && g.cycle_ps() != g.gdCycle_ps) missing("a flexray:CYCLE of a whole number of macroticks");
  if (!given("gdBit")) g.gdBit_ps = kPicosecondsPerSecond / g.baudrate;
  // Wake-up symbols last for times that are the same at every bit rate.
  const auto assume = [&](std::string_view parameter, std::int64_t value) {
    if (!given(parameter)) set_next_to(g, file::kGlobalIntegers, parameter, value);
  };
  const std::int64_t tenth_us = std::max<std::int64_t>(g.gdBit_ps / 100'000, 1);
  assume("gdWakeupSymbolTxLow", 60 / tenth_us);
  assume("gdWakeupSymbolTxIdle", 180 / tenth_us);
  assume("gdWakeupSymbolRxLow", 55 / tenth_us);
  assume("gdWakeupSymbolRxIdle", (60 - 1) / tenth_us);
  assume("gdWakeupSymbolRxWindow", 300 / tenth_us + 1);
  for (const auto& p : file::kGlobalScaled)
    if (!given(p.name) && (g.*p.member < p.low || g.*p.member > p.high))
      missing(fmt::format("parameters from which {} follows in {}..{} {}", p.name, scaled_text(p.low, p.scale),
                          scaled_text(p.high, p.scale), p.unit));
  // Constraint 18: the rest of the cycle.
  const int action_points =
      g.gNumberOfMinislots == 0 ? 0 : std::max(g.gdActionPointOffset - g.gdMinislotActionPointOffset, 0);
  if (!given("gdNIT"))
    set_next_to(g, file::kGlobalIntegers, "gdNIT",
                std::int64_t{g.gMacroPerCycle} - g.gdStaticSlot * g.gNumberOfStaticSlots - action_points -
                    g.gdMinislot * g.gNumberOfMinislots - g.gdSymbolWindow);
  if (!given("gOffsetCorrectionStart"))
    set_next_to(g, file::kGlobalIntegers, "gOffsetCorrectionStart", std::int64_t{g.gMacroPerCycle} - g.gdNIT + 1);
  if (!given("gdMaxMicrotick")) {
    std::int64_t longest = 12'500;
    for (const FibexEcu& ecu : file.ecus) longest = std::max(longest, ecu.parameters.pdMicrotick_ps);
    g.gdMaxMicrotick_ps = longest;
  }
  const auto mark = [&](std::string_view parameter) {
    if (!given(parameter) && parameter != "gCycleCountMax") assumed.insert(fmt::format("flexray.{}", parameter));
  };
  for (const auto& p : file::kGlobalIntegers) mark(p.name);
  for (const auto& p : file::kGlobalScaled) mark(p.name);
}

model::NodeParameters assume_local(const FibexEcu& ecu, const model::GlobalParameters& global, int first_slot,
                                   std::set<std::string, std::less<>>& assumed) {
  model::NodeParameters p = ecu.parameters;
  const auto given = [&](std::string_view parameter) { return ecu.given.find(parameter) != ecu.given.end(); };
  const auto assume = [&](std::string_view parameter, std::int64_t value) {
    if (!given(parameter)) set_next_to(p, file::kNodeIntegers, parameter, value);
  };
  // pSamplesPerMicrotick = 8 pdMicrotick / gdBit; a common microtick is 25 ns, or one sample if that is longer.
  const std::int64_t sample_ps = std::max<std::int64_t>(global.gdBit_ps / model::kSamplesPerBit, 1);
  if (!given("pdMicrotick"))
    p.pdMicrotick_ps = given("pSamplesPerMicrotick")
                           ? std::clamp<std::int64_t>(p.pSamplesPerMicrotick * sample_ps, 12'500, 50'000)
                           : std::clamp<std::int64_t>(sample_ps, 25'000, 50'000);
  assume("pSamplesPerMicrotick", p.pdMicrotick_ps / sample_ps);
  assume("pMicroPerCycle", global.cycle_ps() / p.pdMicrotick_ps);
  // Two clocks with opposite drifts of cClockDeviationMax = 0.0015 differ by 0.003 / (1 - 0.0015) of a cycle
  // after one cycle.
  const std::int64_t drift = ecu.max_drift.value_or(model::ceil_div(std::int64_t{p.pMicroPerCycle} * 6, 1997));
  assume("pRateCorrectionOut", drift);
  assume("pdListenTimeout", 2 * (std::int64_t{p.pMicroPerCycle} + p.pRateCorrectionOut));
  const std::int64_t precision = model::ceil_div(assumed_precision_ps(global), p.pdMicrotick_ps);
  assume("pOffsetCorrectionOut", precision);
  assume("pdAcceptedStartupRange", model::ceil_div(model::scaled(assumed_precision_ps(global)),
                                                   p.pdMicrotick_ps * (model::kWhole - model::kDeviation)));
  assume("pDelayCompensationA", global.gdMinPropagationDelay_ps / p.pdMicrotick_ps);
  assume("pDelayCompensationB", global.gdMinPropagationDelay_ps / p.pdMicrotick_ps);
  const auto initial_offset = [&](int delay) {
    return global.gdActionPointOffset +
           model::ceil_div((p.pDecodingCorrection + delay) * p.pdMicrotick_ps, global.gdMacrotick_ps);
  };
  assume("pMacroInitialOffsetA", initial_offset(p.pDelayCompensationA));
  assume("pMacroInitialOffsetB", initial_offset(p.pDelayCompensationB));
  assume("pKeySlotId", first_slot);
  const auto mark = [&](std::string_view parameter) {
    if (!given(parameter)) assumed.insert(fmt::format("nodes.{}.flexray.{}", ecu.name, parameter));
  };
  for (const auto& one : file::kNodeIntegers) mark(one.name);
  for (const auto& one : file::kNodeScaled) mark(one.name);
  for (const auto& one : file::kNodeFlags) mark(one.name);
  for (const char* one : {"pChannels", "pWakeupChannel"}) mark(one);
  return p;
}

}  // namespace ttf::schedules::exchange::fibex
