// Drawn sets of FlexRay parameters: those that keep every constraint, and those that break one.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/random.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/minislots.h"
#include "schedules/analysis/parameter_bounds.h"
#include "schedules/check/constraints.h"
#include "schedules/model/wire_times.h"
#include "tests/bus/layouts.h"

namespace ttf::sim::engine {

using schedules::check::Constrained;
using schedules::check::Constraint;
using schedules::model::GlobalParameters;
using schedules::model::NodeParameters;

inline std::int64_t up(double value) { return static_cast<std::int64_t>(std::ceil(value)); }

// A constraint that a set breaks, how, if there are two ways, and where.
struct Broken {
  std::string constraint, how, where;
};

inline constexpr int kDynamicWords = 4;  // a list of three elements

// Draws clusters of status frames within the specification's ranges. Each parameter with a constraint has its bound, and
// some room. One in two has a dynamic segment, in which each node sends a list in each cycle.
class Drawn {
 public:
  explicit Drawn(std::uint32_t index) : draw_({1, index, Purpose::kTest, 77, 0}) {}

  schedules::model::Cluster cluster() {
    schedules::model::Cluster made;
    made.name = "drawn";
    GlobalParameters& g = made.flexray;
    bits(g);
    const int nodes = number(2, 5);
    g.gClusterDriftDamping = number(0, 4);
    g.gdMaxPropagationDelay_ps = 100'000 * number(1, 25);
    g.gdMinPropagationDelay_ps = g.gdMaxPropagationDelay_ps / 4 * number(0, 2);
    g.gdTSSTransmitter = number(3, 15);
    g.gPayloadLengthStatic = number(0, 20);
    const double precision = static_cast<double>(schedules::model::assumed_precision_ps(g));
    const double macrotick = static_cast<double>(g.gdMacrotick_ps), slow = 0.9985;
    g.gdActionPointOffset = static_cast<int>(std::max<std::int64_t>(
                                up((precision - static_cast<double>(g.gdMinPropagationDelay_ps)) / macrotick), 1)) +
                            number(0, 2);
    g.gdStaticSlot = static_cast<int>(schedules::analysis::shortest_static_slot(g)) + number(0, 3);
    g.gNumberOfStaticSlots = nodes + number(0, 6);
    if (number(1, 2) == 1) dynamic_segment(g, nodes);
    const std::int64_t per_macrotick = g.gdMacrotick_ps / microtick_ps_;
    const std::int64_t least = up(precision / static_cast<double>(microtick_ps_));
    const int room =
        static_cast<int>(up(static_cast<double>(least + 2) / (slow * static_cast<double>(per_macrotick) - 2)));
    const int correction = room + number(1, 40);
    g.gdNIT = std::max(correction + number(1, 40), 2);
    g.gMacroPerCycle = g.gdStaticSlot * g.gNumberOfStaticSlots + schedules::model::action_point_difference(g) +
                       g.gdMinislot * g.gNumberOfMinislots + g.gdNIT;
    g.gdCycle_ps = g.cycle_ps();
    g.gOffsetCorrectionStart = g.gMacroPerCycle - correction;
    g.gSyncNodeMax = std::max(nodes, 2);
    g.gdCASRxLowMax =
        std::max<int>(67, static_cast<int>(up(2 * (g.gdTSSTransmitter + 30) * 1.0015 / slow))) + number(0, 8);
    const std::int64_t worst_ppm = number(0, 1500);
    for (int n = 0; n < nodes; ++n) {
      schedules::model::Node node;
      node.name = "node" + std::to_string(n);
      node.max_drift_ppb = worst_ppm * 1000;
      node.microtick_ps = microtick_ps_;
      node.flexray.emplace();
      parameters(g, precision, worst_ppm, *node.flexray);
      node.flexray->pKeySlotId = n + 1;
      node.flexray->pKeySlotUsedForSync = n < 2 || draw_.uniform() < 0.8;
      node.flexray->pKeySlotUsedForStartup = node.flexray->pKeySlotUsedForSync && (n < 3 || draw_.uniform() < 0.5);
      if (n == 2) node.flexray->pKeySlotUsedForSync = node.flexray->pKeySlotUsedForStartup = true;
      made.nodes.push_back(std::move(node));
      made.frames.push_back({n + 1, schedules::model::Channels::kAB, 0, 1, static_cast<NodeId>(n), kNoPdu, 0, 0});
    }
    for (int n = 0; n < nodes && g.gNumberOfMinislots > 0; ++n) {
      made.pdus.push_back(bus::list_layout(4, 3, 3));
      made.frames.push_back({g.gNumberOfStaticSlots + n + 1, schedules::model::Channels::kAB, 0, 1,
                             static_cast<NodeId>(n), static_cast<PduId>(n), 0, 0});
    }
    set_latest_tx(made);
    return made;
  }
  // Breaks one constraint, in one node, in all or in the cluster.
  Broken broken(schedules::model::Cluster& cluster) {
    const schedules::model::Cluster sound = cluster;
    for (;;) {
      if (std::optional<Broken> done = tried(cluster)) return *done;
      cluster = sound;
    }
  }

 private:
  // Returns nothing if the parameter's range leaves no room.
  std::optional<Broken> tried(schedules::model::Cluster& cluster) {
    NodeParameters& p =
        *cluster.nodes[static_cast<std::size_t>(number(0, static_cast<int>(cluster.nodes.size()) - 1))].flexray;
    const NodeParameters before = p;
    std::optional<Broken> done = tried(cluster.flexray, p);
    const bool in_all = draw_.uniform() < 0.5;
    for (int NodeParameters::*const member :
         {&NodeParameters::pdListenTimeout, &NodeParameters::pdAcceptedStartupRange,
          &NodeParameters::pDelayCompensationA, &NodeParameters::pDelayCompensationB,
          &NodeParameters::pOffsetCorrectionOut, &NodeParameters::pRateCorrectionOut,
          &NodeParameters::pClusterDriftDamping, &NodeParameters::pMicroPerCycle}) {
      if (!done || (p.*member == before.*member && p.pMicroPerCycle == before.pMicroPerCycle)) continue;
      done->where = in_all ? ", in all nodes" : ", in one node";
      for (auto& node : cluster.nodes)
        if (in_all) node.flexray.value().*member = p.*member;
    }
    if (done && done->constraint == "longest_microtick")
      for (auto& node : cluster.nodes)
        node.flexray->pClusterDriftDamping =
            std::min(node.flexray->pClusterDriftDamping, most_damping(cluster.flexray));
    set_latest_tx(cluster);
    return done;
  }

  std::optional<Broken> tried(GlobalParameters& g, NodeParameters& p) {
    const auto within = [&](int& parameter, std::int64_t low, std::int64_t high) {
      if (low > high) return false;
      parameter = static_cast<int>(draw_.integer(low, high));
      return true;
    };
    const std::int64_t precision = schedules::model::assumed_precision_ps(g);
    const std::int64_t most_delay = (g.gdMaxPropagationDelay_ps + microtick_ps_ - 1) / microtick_ps_;
    const std::int64_t least_delay = g.gdMinPropagationDelay_ps / microtick_ps_;
    switch (number(0, 20)) {
      case 0: {  // evenly in the logarithm: the shortest do most harm
        const double ratio = std::pow(1284.0 / p.pdListenTimeout, draw_.uniform());
        p.pdListenTimeout = static_cast<int>(std::min(p.pdListenTimeout * ratio, p.pdListenTimeout - 1.0));
        return Broken{"listen_timeout", ", too short", ""};
      }
      case 1: return named("listen_timeout", within(p.pdListenTimeout, p.pdListenTimeout + 1, 1'283'846), ", too long");
      case 2:
        return named("accepted_startup_range", within(p.pdAcceptedStartupRange, 0, precision / microtick_ps_ - 1));
      case 3: return named("delay_compensation_a", within(p.pDelayCompensationA, most_delay + 1, 200), ", too long");
      case 4: return named("delay_compensation_b", within(p.pDelayCompensationB, most_delay + 1, 200), ", too long");
      case 5: return named("cas_length", within(g.gdCASRxLowMax, 67, 2 * (g.gdTSSTransmitter + 30)));
      case 6: {
        const int before = schedules::model::action_point_difference(g);
        const bool possible =
            within(g.gdActionPointOffset, 1, (precision - g.gdMinPropagationDelay_ps - 1) / g.gdMacrotick_ps);
        g.gdNIT += before - schedules::model::action_point_difference(g);
        return named("action_point", possible);
      }
      case 7:
        return named("offset_correction", within(p.pOffsetCorrectionOut, 5, precision / microtick_ps_ - 1),
                     ", too small");
      case 8: {
        if (!within(p.pRateCorrectionOut, 2, least_rate_ - 1)) return std::nullopt;
        p.pdListenTimeout = 2 * (p.pMicroPerCycle + p.pRateCorrectionOut);
        return Broken{"rate_correction", "", ""};
      }
      case 9: return named("delay_compensation_a", within(p.pDelayCompensationA, 0, least_delay - 1), ", too short");
      case 10: return named("delay_compensation_b", within(p.pDelayCompensationB, 0, least_delay - 1), ", too short");
      case 11:
        return named("offset_correction", within(p.pOffsetCorrectionOut, most_offset_correction(g, p) + 1, 15'266),
                     ", too large");
      case 12: {
        g.gMaxWithoutClockCorrectionPassive = number(2, 15);
        return named("fatal_after_passive",
                     within(g.gMaxWithoutClockCorrectionFatal, 1, g.gMaxWithoutClockCorrectionPassive - 1));
      }
      case 13: return named("drift_damping", within(p.pClusterDriftDamping, most_damping(g) + 1, 20));
      case 14: {
        g.gdMaxMicrotick_ps = microtick_ps_ / 2;
        return named("longest_microtick", g.gdMaxMicrotick_ps >= 12'500);
      }
      case 15: return named("microticks_per_cycle", other_microticks(g, p));
      case 16:
        return named("offset_correction_start", within(g.gOffsetCorrectionStart, 9, g.gMacroPerCycle - g.gdNIT - 1));
      case 17: {
        const int before = g.gdStaticSlot;
        const bool possible = within(g.gdStaticSlot, std::max(g.gdActionPointOffset + 1, 4),
                                     schedules::analysis::shortest_static_slot(g) - 1);
        g.gdNIT += (before - g.gdStaticSlot) * g.gNumberOfStaticSlots;
        return named("static_slot", possible);
      }
      case 18: return named("minislot_action_point", earlier_minislot_action_point(g));
      case 19: return named("minislot", shorter_minislot(g));
      case 20:
        return named("idle_phase",
                     g.gNumberOfMinislots > 0 && within(g.gdDynamicSlotIdlePhase, 0, least_idle_phase(g) - 1));
      default: return std::nullopt;
    }
  }
  // Another cycle by up to one in a hundred, evenly in the logarithm. The listen timeout follows it, and both corrections
  // keep their bounds.
  bool other_microticks(const GlobalParameters& g, NodeParameters& p) {
    const auto most = static_cast<double>(p.pMicroPerCycle) / 100;
    const int change = static_cast<int>(std::pow(most, draw_.uniform()));
    p.pMicroPerCycle += number(0, 1) == 0 ? -change : change;
    p.pRateCorrectionOut = std::max(p.pRateCorrectionOut, static_cast<int>(least_rate_) + 2 * change / 100 + 1);
    p.pdListenTimeout = 2 * (p.pMicroPerCycle + p.pRateCorrectionOut);
    p.pOffsetCorrectionOut = std::min(p.pOffsetCorrectionOut, static_cast<int>(most_offset_correction(g, p)));
    return p.pOffsetCorrectionOut * p.pdMicrotick_ps >= schedules::model::assumed_precision_ps(g);
  }
  // Only if the network idle time has room for a later begin of the dynamic segment.
  bool earlier_minislot_action_point(GlobalParameters& g) {
    const int difference = schedules::model::action_point_difference(g);
    const int least = least_minislot_action_point(g);
    if (g.gNumberOfMinislots == 0 || least <= 1) return false;
    g.gdMinislotActionPointOffset = number(1, least - 1);
    g.gdNIT -= schedules::model::action_point_difference(g) - difference;
    return g.gOffsetCorrectionStart >= g.gMacroPerCycle - g.gdNIT && g.gdNIT >= 2;
  }
  // More and shorter minislots in the same time.
  bool shorter_minislot(GlobalParameters& g) {
    const int least = least_minislot(g), time = g.gdMinislot * g.gNumberOfMinislots;
    if (g.gNumberOfMinislots == 0 || least - 1 <= g.gdMinislotActionPointOffset) return false;
    g.gdMinislot = number(g.gdMinislotActionPointOffset + 1, least - 1);
    g.gNumberOfMinislots = time / g.gdMinislot;
    g.gdNIT += time % g.gdMinislot;
    g.gdDynamicSlotIdlePhase = std::max(g.gdDynamicSlotIdlePhase, least_idle_phase(g));
    return g.gdDynamicSlotIdlePhase <= 2;
  }
  static std::optional<Broken> named(const char* name, bool possible, const char* how = "") {
    return possible ? std::optional<Broken>({name, how, ""}) : std::nullopt;
  }
  static std::int64_t most_offset_correction(const GlobalParameters& g, const NodeParameters& p) {
    const std::int64_t macroticks = g.gMacroPerCycle - g.gOffsetCorrectionStart;
    return macroticks * (p.pMicroPerCycle - p.pRateCorrectionOut) / g.gMacroPerCycle - macroticks;
  }
  int most_damping(const GlobalParameters& g) const {
    return static_cast<int>(g.gClusterDriftDamping * g.gdMaxMicrotick_ps / microtick_ps_);
  }
  // The shortest macrotick, and the terms of the dynamic segment, in picoseconds.
  static double shortest_macrotick(const GlobalParameters& g) { return 0.9985 * static_cast<double>(g.gdMacrotick_ps); }
  static double precision_of(const GlobalParameters& g) {
    return static_cast<double>(schedules::model::assumed_precision_ps(g));
  }
  static int least_minislot_action_point(const GlobalParameters& g) {
    const double early = precision_of(g) - static_cast<double>(g.gdMinPropagationDelay_ps);
    return static_cast<int>(std::max<std::int64_t>(up(early / shortest_macrotick(g)), 1));
  }
  static int least_minislot(const GlobalParameters& g) {
    const double late = precision_of(g) + static_cast<double>(g.gdMaxPropagationDelay_ps);
    return g.gdMinislotActionPointOffset + static_cast<int>(up(late / shortest_macrotick(g)));
  }
  static int least_idle_phase(const GlobalParameters& g) {
    const double idle = 11 * 1.0015 * static_cast<double>(g.gdBit_ps) + precision_of(g) +
                        static_cast<double>(g.gdMaxPropagationDelay_ps);
    const double left = idle - (g.gdMinislot - g.gdMinislotActionPointOffset) * shortest_macrotick(g);
    return static_cast<int>(std::max<std::int64_t>(up(left / (g.gdMinislot * shortest_macrotick(g))), 0));
  }
  void dynamic_segment(GlobalParameters& g, int nodes) {
    g.gdMinislotActionPointOffset = least_minislot_action_point(g) + number(0, 1);
    g.gdMinislot = least_minislot(g) + number(0, 1);
    while (least_idle_phase(g) > 2) ++g.gdMinislot;
    g.gdDynamicSlotIdlePhase = std::min(least_idle_phase(g) + number(0, 1), 2);
    g.gNumberOfMinislots = nodes * static_cast<int>(schedules::analysis::minislots_of(g, kDynamicWords)) + number(0, 4);
  }
  static void set_latest_tx(schedules::model::Cluster& cluster) {
    if (cluster.flexray.gNumberOfMinislots == 0) return;
    for (auto& node : cluster.nodes)
      node.flexray->pLatestTx = static_cast<int>(schedules::analysis::last_start(cluster.flexray, kDynamicWords));
  }
  int number(std::int64_t low, std::int64_t high) { return static_cast<int>(draw_.integer(low, high)); }
  void bits(GlobalParameters& g) {
    g.gdBit_ps = 100'000 << number(0, 2);
    g.baudrate = 1'000'000'000'000 / g.gdBit_ps;
    do {
      samples_ = 1 << number(0, 2);
      microtick_ps_ = samples_ * g.gdBit_ps / 8;
    } while (microtick_ps_ > 50'000);
    g.gdMaxMicrotick_ps = microtick_ps_;
    g.gdMacrotick_ps = 1'000'000 * number(std::max<std::int64_t>(1, 40 * microtick_ps_ / 1'000'000), 6);
    g.gdWakeupSymbolTxLow = static_cast<int>(6'000'000 / g.gdBit_ps);
    g.gdWakeupSymbolTxIdle = static_cast<int>(18'000'000 / g.gdBit_ps);
    g.gdWakeupSymbolRxLow = g.gdWakeupSymbolTxLow - 4;
    g.gdWakeupSymbolRxIdle = (g.gdWakeupSymbolTxIdle - g.gdWakeupSymbolTxLow) / 2 - 1;
    g.gdWakeupSymbolRxWindow = 2 * g.gdWakeupSymbolTxLow + g.gdWakeupSymbolTxIdle + 1;
  }
  void parameters(const GlobalParameters& g, double precision, std::int64_t worst_ppm, NodeParameters& p) {
    p.pdMicrotick_ps = microtick_ps_;
    p.pSamplesPerMicrotick = samples_;
    p.pMicroPerCycle = static_cast<int>(g.gdCycle_ps / microtick_ps_);
    const double drift = static_cast<double>(worst_ppm) * 1e-6;
    least_rate_ = std::max<std::int64_t>(2, up(p.pMicroPerCycle * 2 * drift / (1 - drift)));
    p.pRateCorrectionOut = static_cast<int>(least_rate_) + number(0, 10);
    const std::int64_t least = up(precision / static_cast<double>(microtick_ps_));
    const std::int64_t macroticks = g.gMacroPerCycle - g.gOffsetCorrectionStart;
    const std::int64_t most = macroticks * (p.pMicroPerCycle - p.pRateCorrectionOut) / g.gMacroPerCycle - macroticks;
    p.pOffsetCorrectionOut = number(least, std::max(least, most));
    p.pClusterDriftDamping = number(0, g.gClusterDriftDamping);
    p.pDelayCompensationA = delay(g);
    p.pDelayCompensationB = delay(g);
    const std::int64_t range = up(precision / (static_cast<double>(microtick_ps_) * 0.9985));
    p.pdAcceptedStartupRange = number(range, 2 * range);
    p.pdListenTimeout = 2 * (p.pMicroPerCycle + p.pRateCorrectionOut);
    p.pAllowPassiveToActive = 2;
    p.pAllowHaltDueToClock = true;
  }
  int delay(const GlobalParameters& g) {
    return number(g.gdMinPropagationDelay_ps / microtick_ps_,
                  (g.gdMaxPropagationDelay_ps + microtick_ps_ - 1) / microtick_ps_);
  }

  RandomStream draw_;
  std::int64_t microtick_ps_ = 25'000, least_rate_ = 0;
  int samples_ = 2;
};

// The names of the constraints that do not hold.
inline std::vector<std::string> violated(const schedules::model::Cluster& cluster) {
  std::vector<std::string> names;
  std::int64_t worst = 0;
  for (const auto& node : cluster.nodes) worst = std::max(worst, schedules::analysis::worst_drift_ppb(node));
  const auto add = [&](Constraint::On on, const Constrained& subject) {
    for (const Constraint& one : schedules::check::constraints())
      if (one.on == on && !one.holds(subject) && std::ranges::find(names, one.name) == names.end())
        names.emplace_back(one.name);
  };
  add(Constraint::On::kCluster, {cluster, NodeParameters{}});
  if (cluster.flexray.gNumberOfMinislots > 0) add(Constraint::On::kDynamicSegment, {cluster, NodeParameters{}});
  for (const auto& node : cluster.nodes)
    add(Constraint::On::kController, {cluster, *node.flexray, schedules::analysis::worst_drift_ppb(node), worst});
  return names;
}

}  // namespace ttf::sim::engine
