#include "schedules/check/checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "core/int128.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/model/limits.h"
#include "schedules/model/wire_times.h"

namespace ttf::schedules::check {
namespace {

// FlexRay 2.1A, annex B: cdCAS in gdBit; and a bus driver's longest reaction from idle to activity (electrical physical
// layer 2.1A, dBDRxai).
constexpr std::int64_t kDriverReaction_ps = 400'000;

// 2 gdActionPointOffset + ceil((bits gdBitMax + delays) / (gdMacrotick (1 - cClockDeviationMax))).
std::int64_t around_action_points(const model::GlobalParameters& g, std::int64_t bits, std::int64_t extra_ps) {
  const Int128 time =
      longest_bits(g, bits) + model::scaled(g.gdMinPropagationDelay_ps + g.gdMaxPropagationDelay_ps + extra_ps);
  return 2 * g.gdActionPointOffset + model::ceil_div(time, shortest_macroticks(g, 1));
}

// What an offset correction can take from the macroticks behind gOffsetCorrectionStart, in the shortest cycle that rate
// correction makes, and still leave each of them a microtick. The external terms come on top of both corrections.
std::int64_t offset_correction_room(const model::GlobalParameters& g, const model::NodeParameters& p) {
  const std::int64_t macroticks = g.gMacroPerCycle - g.gOffsetCorrectionStart;
  return macroticks * (p.pMicroPerCycle - p.pRateCorrectionOut - p.pExternRateCorrection) / g.gMacroPerCycle -
         macroticks - p.pExternOffsetCorrection;
}

template <std::size_t N> bool is_one_of(const std::int64_t (&allowed)[N], std::int64_t value) {
  return std::find(std::begin(allowed), std::end(allowed), value) != std::end(allowed);
}

// FlexRay 2.1A: 10, 5 and 2.5 Mbit/s; the sample clock is an eighth of a bit, and a microtick 1, 2 or 4 samples.
constexpr std::int64_t kBits_ps[] = {100'000, 200'000, 400'000};
constexpr std::int64_t kMicroticks_ps[] = {12'500, 25'000, 50'000};
constexpr std::int64_t kSamples[] = {1, 2, 4};

std::string us(std::int64_t ps) { return fmt::format("{} us", static_cast<double>(ps) / 1e6); }
std::string ns(std::int64_t ps) { return fmt::format("{} ns", static_cast<double>(ps) / 1e3); }

}  // namespace

void ClusterFindings::parameter(const std::string& path, const std::string& value, const std::string& expected) {
  const auto line = cluster_.parameter_lines.find(path);
  at(line == cluster_.parameter_lines.end() ? 0 : line->second, path, value, expected);
}

void ClusterFindings::at(int line, const std::string& key, const std::string& value, const std::string& expected) {
  list_.push_back({cluster_.file, line, key, value, expected});
}

std::string task_path(const model::Node& node, const model::Task& task) {
  return fmt::format("nodes.{}.tasks.{}", node.name, task.name);
}

std::string ms(Duration duration) { return fmt::format("{} ms", static_cast<double>(duration.ns) / 1e6); }

std::int64_t shortest_static_slot(const model::GlobalParameters& g) {
  return around_action_points(g, frame_bits(g, g.gPayloadLengthStatic) + model::kIdleDelimiterBits, 0);
}

void check_cycle(const model::Cluster& cluster, ClusterFindings& findings) {
  const model::GlobalParameters& g = cluster.flexray;
  const auto wrong = [&](const char* name, std::int64_t value, const std::string& expected) {
    findings.parameter(fmt::format("flexray.{}", name), fmt::format("{}", value), expected);
  };
  // Constraint 18.
  const int difference = action_point_difference(g);
  const int sum = g.gdStaticSlot * g.gNumberOfStaticSlots + difference + g.gdMinislot * g.gNumberOfMinislots +
                  g.gdSymbolWindow + g.gdNIT;
  if (sum != g.gMacroPerCycle)
    wrong(
        "gMacroPerCycle", g.gMacroPerCycle,
        fmt::format("must be {} macroticks: {} slots x {} + {} (action point difference) + {} minislots x {} + symbol "
                    "window {} + gdNIT {} (constraint 18)",
                    sum, g.gNumberOfStaticSlots, g.gdStaticSlot, difference, g.gNumberOfMinislots, g.gdMinislot,
                    g.gdSymbolWindow, g.gdNIT));
  if (g.cycle_ps() != g.gdCycle_ps)
    findings.parameter("flexray.gdCycle", us(g.gdCycle_ps),
                       fmt::format("must be gMacroPerCycle * gdMacrotick = {}", us(g.cycle_ps())));
  if (g.cycle_ps() % 1000 != 0)
    findings.parameter("flexray.gdCycle", us(g.cycle_ps()), "must be a whole number of nanoseconds");
  if (!is_one_of(kBits_ps, g.gdBit_ps))
    findings.parameter("flexray.gdBit", us(g.gdBit_ps), "must be one of 0.1, 0.2, 0.4 us");
  if (const auto needed = shortest_static_slot(g); g.gdStaticSlot < needed)
    wrong("gdStaticSlot", g.gdStaticSlot,
          fmt::format("must be at least {} macroticks to hold a frame of {} words between its action points", needed,
                      g.gPayloadLengthStatic));
  const std::int64_t precision = assumed_precision_ps(g);
  const std::int64_t action_point =
      model::ceil_div(std::max<std::int64_t>(precision - g.gdMinPropagationDelay_ps, 0), g.gdMacrotick_ps);
  if (g.gdActionPointOffset < action_point)
    wrong("gdActionPointOffset", g.gdActionPointOffset,
          fmt::format("must be at least {} macroticks: the assumed precision is {}", action_point, us(precision)));
  if (g.gdSymbolWindow > 0) {
    const std::int64_t needed =
        around_action_points(g, g.gdTSSTransmitter + model::kCasBits + model::kIdleDelimiterBits, kDriverReaction_ps);
    if (g.gdSymbolWindow < needed)
      wrong("gdSymbolWindow", g.gdSymbolWindow,
            fmt::format("must be 0 (none) or at least {} macroticks (constraint 16)", needed));
  }
  if (cluster.guardian && cluster.topology != model::Topology::kStar)
    findings.parameter("guardian", "true", "needs topology: star, in whose middle it sits");
  if (g.gOffsetCorrectionStart < g.gMacroPerCycle - g.gdNIT || g.gOffsetCorrectionStart >= g.gMacroPerCycle)
    wrong("gOffsetCorrectionStart", g.gOffsetCorrectionStart,
          fmt::format("must lie in the network idle time, {}..{} macroticks", g.gMacroPerCycle - g.gdNIT,
                      g.gMacroPerCycle - 1));
  if (static_cast<Int128>(g.gdBit_ps) * g.baudrate != 1'000'000'000'000)
    wrong("baudrate", g.baudrate, fmt::format("must be 1 / gdBit, with gdBit = {}", us(g.gdBit_ps)));
  if (g.gNumberOfStaticSlots + g.gNumberOfMinislots > model::kLastSlot)
    wrong("gNumberOfMinislots", g.gNumberOfMinislots,
          fmt::format("must be at most {}: frame ids end at {}", model::kLastSlot - g.gNumberOfStaticSlots,
                      model::kLastSlot));
  if (g.gMaxWithoutClockCorrectionFatal < g.gMaxWithoutClockCorrectionPassive)
    wrong("gMaxWithoutClockCorrectionFatal", g.gMaxWithoutClockCorrectionFatal,
          fmt::format("must be {}..15: not below gMaxWithoutClockCorrectionPassive",
                      g.gMaxWithoutClockCorrectionPassive));
  if (g.gdMinPropagationDelay_ps > g.gdMaxPropagationDelay_ps)
    findings.parameter("flexray.gdMinPropagationDelay", us(g.gdMinPropagationDelay_ps),
                       fmt::format("must be at most gdMaxPropagationDelay = {}", us(g.gdMaxPropagationDelay_ps)));
  if (g.gNumberOfMinislots > 0 && g.gdMinislotActionPointOffset >= g.gdMinislot)
    wrong("gdMinislotActionPointOffset", g.gdMinislotActionPointOffset,
          fmt::format("must be below gdMinislot = {} macroticks", g.gdMinislot));
}

// The key slot is the node's own, static, on all its channels, in every cycle. Where the node sends in nothing else
// until its host commands ALL_SLOTS, it must have nothing else to send: no host gives that command on its own.
void check_key_slot(const model::Cluster& cluster, NodeId id, ClusterFindings& findings) {
  const model::Node& node = cluster.node(id);
  const model::NodeParameters& p = *node.flexray;
  const model::FrameSlot* other = nullptr;
  bool owns = false;
  for (const model::FrameSlot& frame : cluster.frames) {
    if (frame.sender != id) continue;
    owns |= frame.slot == p.pKeySlotId && frame.repetition == 1 && frame.channels == p.pChannels &&
            !is_dynamic(cluster.flexray, frame);
    if (frame.slot != p.pKeySlotId && other == nullptr) other = &frame;
  }
  if (!owns)
    findings.parameter(fmt::format("nodes.{}.flexray.pKeySlotId", node.name), fmt::format("{}", p.pKeySlotId),
                       fmt::format("must be a static slot that {} owns on {} in every cycle", node.name,
                                   p.pChannels == model::Channels::kAB ? "both channels" : "its channel"));
  if (p.pKeySlotOnlyEnabled && other != nullptr)
    findings.parameter(
        fmt::format("nodes.{}.flexray.pKeySlotOnlyEnabled", node.name), "true",
        fmt::format("must be false: {} also has slot {} (line {}), but would send in its key slot only until "
                    "a host commands ALL_SLOTS",
                    node.name, other->slot, other->line));
}

void check_clocks(const model::Cluster& cluster, ClusterFindings& findings) {
  const model::GlobalParameters& g = cluster.flexray;
  std::int64_t worst_drift = 0;
  int sync = 0, startup = 0, controllers = 0;
  for (const model::Node& node : cluster.nodes)
    if (node.flexray) {
      worst_drift = std::max(worst_drift, analysis::worst_drift_ppb(node));
      ++controllers;
      sync += node.flexray->pKeySlotUsedForSync ? 1 : 0;
      startup += node.flexray->pKeySlotUsedForStartup ? 1 : 0;
    }
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    const model::Node& node = cluster.nodes[n];
    if (node.drift_ppb && std::abs(*node.drift_ppb) > node.max_drift_ppb)
      findings.parameter(
          fmt::format("nodes.{}.drift_ppm", node.name), fmt::format("{}", static_cast<double>(*node.drift_ppb) / 1e3),
          fmt::format("must be within +-max_drift_ppm = {}", static_cast<double>(node.max_drift_ppb) / 1e3));
    if (!node.flexray) continue;
    const model::NodeParameters& p = *node.flexray;
    const auto wrong = [&](const char* name, const std::string& value, const std::string& expected) {
      findings.parameter(fmt::format("nodes.{}.flexray.{}", node.name, name), value, expected);
    };
    const auto text = [](std::int64_t value) { return fmt::format("{}", value); };
    if (static_cast<Int128>(p.pMicroPerCycle) * p.pdMicrotick_ps != g.gdCycle_ps)
      wrong("pMicroPerCycle", text(p.pMicroPerCycle),
            fmt::format("must make gdCycle = {} out of microticks of {}", us(g.gdCycle_ps), ns(p.pdMicrotick_ps)));
    if (p.pdMicrotick_ps > g.gdMaxMicrotick_ps)
      wrong("pdMicrotick", ns(p.pdMicrotick_ps),
            fmt::format("must be at most gdMaxMicrotick = {}", ns(g.gdMaxMicrotick_ps)));
    if (!is_one_of(kMicroticks_ps, p.pdMicrotick_ps))
      wrong("pdMicrotick", ns(p.pdMicrotick_ps), "must be one of 12.5, 25, 50 ns");
    if (!is_one_of(kSamples, p.pSamplesPerMicrotick))
      wrong("pSamplesPerMicrotick", text(p.pSamplesPerMicrotick), "must be one of 1, 2, 4");
    else if (8 * p.pdMicrotick_ps != p.pSamplesPerMicrotick * g.gdBit_ps)
      wrong("pSamplesPerMicrotick", text(p.pSamplesPerMicrotick),
            fmt::format("must be as many samples of gdBit / 8 = {} as make pdMicrotick = {}", ns(g.gdBit_ps / 8),
                        ns(p.pdMicrotick_ps)));
    // Against the node that is farthest off to the other side, counted in own microticks.
    const std::int64_t rate =
        model::ceil_div(static_cast<Int128>(p.pMicroPerCycle) * (analysis::worst_drift_ppb(node) + worst_drift),
                        1'000'000'000 - worst_drift);
    if (p.pRateCorrectionOut < rate)
      wrong("pRateCorrectionOut", text(p.pRateCorrectionOut),
            fmt::format("must be at least {} microticks to follow the worst drift between two nodes", rate));
    const std::int64_t offset = model::ceil_div(assumed_precision_ps(g), p.pdMicrotick_ps);
    const std::int64_t room = offset_correction_room(g, p);
    if (p.pOffsetCorrectionOut < offset || p.pOffsetCorrectionOut > room)
      wrong("pOffsetCorrectionOut", text(p.pOffsetCorrectionOut),
            fmt::format("must be {}..{} microticks: from the assumed precision to what fits behind "
                        "gOffsetCorrectionStart at the fastest rate",
                        offset, room));
    if (static_cast<std::int64_t>(p.pClusterDriftDamping) * p.pdMicrotick_ps >
        static_cast<std::int64_t>(g.gClusterDriftDamping) * g.gdMaxMicrotick_ps)
      wrong("pClusterDriftDamping", text(p.pClusterDriftDamping),
            fmt::format("must not exceed gClusterDriftDamping = {} longest microticks", g.gClusterDriftDamping));
    if (p.pLatestTx > g.gNumberOfMinislots)
      wrong("pLatestTx", text(p.pLatestTx),
            fmt::format("must be at most gNumberOfMinislots = {}", g.gNumberOfMinislots));
    if (p.pKeySlotUsedForStartup && !p.pKeySlotUsedForSync)
      wrong("pKeySlotUsedForStartup", "true", "needs pKeySlotUsedForSync: a startup frame is a sync frame");
    if (!includes(p.pChannels, p.pWakeupChannel))
      wrong("pWakeupChannel", p.pWakeupChannel == model::Channel::kA ? "A" : "B",
            fmt::format("must be a channel that {} is attached to (pChannels = {})", node.name,
                        channels_text(p.pChannels)));
    check_key_slot(cluster, static_cast<NodeId>(n), findings);
  }
  if (controllers < 2)
    findings.parameter("nodes", fmt::format("{}", controllers), "must have at least 2 nodes on FlexRay");
  if (sync < 2 || sync > g.gSyncNodeMax)
    findings.parameter(
        "flexray.gSyncNodeMax", fmt::format("{}", g.gSyncNodeMax),
        fmt::format("must allow the nodes with pKeySlotUsedForSync, which must be at least 2: there are {}", sync));
  const int needed = std::min(controllers, 3);
  if (startup < std::max(needed, 2))
    findings.parameter("nodes", fmt::format("{}", startup),
                       fmt::format("must have at least {} nodes with pKeySlotUsedForStartup", std::max(needed, 2)));
}

std::vector<Finding> check(const model::Cluster& cluster) {
  ClusterFindings findings(cluster);
  check_cycle(cluster, findings);
  check_clocks(cluster, findings);
  check_slots(cluster, findings);
  check_dynamic(cluster, findings);
  check_can(cluster, findings);
  check_tasks(cluster, findings);
  check_flow(cluster, findings);
  check_loops(cluster, findings);
  return findings.take();
}

}  // namespace ttf::schedules::check
