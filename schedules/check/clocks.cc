// The checker's rules about clocks and start-up nodes: one table for nodes, one for controllers, one for the
// cluster. A finding is about one parameter, in the order of the tables. The constraints of FlexRay's annex B have a
// table of their own (constraints.h).
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "schedules/analysis/clock_bounds.h"
#include "schedules/check/checker.h"
#include "schedules/check/constraints.h"

namespace ttf::schedules::check {
namespace {

template <class Subject> struct Rule {
  const char* parameter;
  bool (*holds)(const Subject&);
  std::string (*value)(const Subject&);
  std::string (*sentence)(const Subject&);
};

template <class Subject, std::size_t count>
void check_rules(const Rule<Subject> (&rules)[count], const Subject& subject, const std::string& path,
                 ClusterFindings& findings) {
  for (const Rule<Subject>& rule : rules)
    if (!rule.holds(subject)) findings.parameter(path + rule.parameter, rule.value(subject), rule.sentence(subject));
}

std::string ppm(std::int64_t ppb) { return fmt::format("{}", static_cast<double>(ppb) / 1e3); }

using N = const model::Node&;
constexpr Rule<model::Node> kNodeRules[] = {
    {"drift_ppm", [](N n) { return !n.drift_ppb || std::abs(*n.drift_ppb) <= n.max_drift_ppb; },
     [](N n) { return ppm(*n.drift_ppb); },
     [](N n) { return fmt::format("must be within +-max_drift_ppm = {}", ppm(n.max_drift_ppb)); }},
};

// FlexRay 2.1A: a microtick is 1, 2 or 4 samples.
constexpr std::int64_t kMicroticks_ps[] = {12'500, 25'000, 50'000};
constexpr std::int64_t kSamples[] = {1, 2, 4};

struct Controller {
  const model::Cluster& cluster;
  NodeId id;
  const model::GlobalParameters& g = cluster.flexray;
  const model::Node& node = cluster.node(id);
  const model::NodeParameters& p = *node.flexray;
};

// Checks that the key slot is static and the node's own, on all its channels, in every cycle.
bool owns_its_key_slot(const Controller& c) {
  return std::any_of(c.cluster.frames.begin(), c.cluster.frames.end(), [&](const model::FrameSlot& frame) {
    return frame.sender == c.id && frame.slot == c.p.pKeySlotId && frame.repetition == 1 &&
           frame.channels == c.p.pChannels && !is_dynamic(c.g, frame);
  });
}

const model::FrameSlot* frame_in_another_slot(const Controller& c) {
  for (const model::FrameSlot& frame : c.cluster.frames)
    if (frame.sender == c.id && frame.slot != c.p.pKeySlotId) return &frame;
  return nullptr;
}

using C = const Controller&;
constexpr Rule<Controller> kControllerRules[] = {
    {"pdMicrotick", [](C c) { return is_one_of(kMicroticks_ps, c.p.pdMicrotick_ps); },
     [](C c) { return ns(c.p.pdMicrotick_ps); }, [](C) -> std::string { return "must be one of 12.5, 25, 50 ns"; }},
    {"pSamplesPerMicrotick", [](C c) { return is_one_of(kSamples, c.p.pSamplesPerMicrotick); },
     [](C c) { return number(c.p.pSamplesPerMicrotick); }, [](C) -> std::string { return "must be one of 1, 2, 4"; }},
    {"pSamplesPerMicrotick",
     [](C c) {
       return !is_one_of(kSamples, c.p.pSamplesPerMicrotick) ||
              model::kSamplesPerBit * c.p.pdMicrotick_ps == c.p.pSamplesPerMicrotick * c.g.gdBit_ps;
     },
     [](C c) { return number(c.p.pSamplesPerMicrotick); },
     [](C c) {
       return fmt::format("must be pdMicrotick = {1} divided by a sample, gdBit / 8 = {0}",
                          ns(c.g.gdBit_ps / model::kSamplesPerBit), ns(c.p.pdMicrotick_ps));
     }},
    {"pLatestTx", [](C c) { return c.p.pLatestTx <= c.g.gNumberOfMinislots; },
     [](C c) { return number(c.p.pLatestTx); },
     [](C c) { return fmt::format("must be at most gNumberOfMinislots = {}", c.g.gNumberOfMinislots); }},
    {"pKeySlotUsedForStartup", [](C c) { return !c.p.pKeySlotUsedForStartup || c.p.pKeySlotUsedForSync; },
     [](C) -> std::string { return "true"; },
     [](C) -> std::string { return "needs pKeySlotUsedForSync: a startup frame is a sync frame"; }},
    {"pWakeupChannel", [](C c) { return includes(c.p.pChannels, c.p.pWakeupChannel); },
     [](C c) -> std::string { return c.p.pWakeupChannel == model::Channel::kA ? "A" : "B"; },
     [](C c) {
       return fmt::format("must be a channel that {} is attached to (pChannels = {})", c.node.name,
                          channels_text(c.p.pChannels));
     }},
    {"pKeySlotId", owns_its_key_slot, [](C c) { return number(c.p.pKeySlotId); },
     [](C c) {
       return fmt::format("must be a static slot that {} owns on {} in every cycle", c.node.name,
                          c.p.pChannels == model::Channels::kAB ? "both channels" : "its channel");
     }},
    // In single-slot mode a node sends only in its key slot until its host commands ALL_SLOTS. No host sends
    // that command, so the node must have no other frame.
    {"pKeySlotOnlyEnabled", [](C c) { return !c.p.pKeySlotOnlyEnabled || frame_in_another_slot(c) == nullptr; },
     [](C) -> std::string { return "true"; },
     [](C c) {
       const model::FrameSlot& other = *frame_in_another_slot(c);
       return fmt::format(
           "must be false: {} also has slot {} ({}), but would send in its key slot only until "
           "a host commands ALL_SLOTS",
           c.node.name, other.slot, place_text(c.cluster, other.line));
     }},
};

// Counts the nodes with a controller, the sync nodes and the startup nodes.
struct Members {
  int most_sync = 0;  // gSyncNodeMax
  int controllers = 0, sync = 0, startup = 0;
};

// A cluster of two nodes needs both, a larger one three.
int least_startup(const Members& m) { return std::clamp(m.controllers, 2, 3); }

using M = const Members&;
constexpr Rule<Members> kClusterRules[] = {
    {"nodes", [](M m) { return m.controllers >= 2; }, [](M m) { return number(m.controllers); },
     [](M) -> std::string { return "must have at least 2 nodes on FlexRay"; }},
    {"flexray.gSyncNodeMax", [](M m) { return m.sync >= 2 && m.sync <= m.most_sync; },
     [](M m) { return number(m.most_sync); },
     [](M m) {
       return fmt::format("must be at least the number of nodes with pKeySlotUsedForSync, {}, which must be at least 2",
                          m.sync);
     }},
    {"nodes", [](M m) { return m.startup >= least_startup(m); }, [](M m) { return number(m.startup); },
     [](M m) { return fmt::format("must have at least {} nodes with pKeySlotUsedForStartup", least_startup(m)); }},
};

}  // namespace

void check_clocks(const model::Cluster& cluster, ClusterFindings& findings) {
  Members members{.most_sync = cluster.flexray.gSyncNodeMax};
  std::int64_t worst_drift = 0;
  for (const model::Node& node : cluster.nodes) {
    if (!node.flexray) continue;
    worst_drift = std::max(worst_drift, analysis::worst_drift_ppb(node));
    ++members.controllers;
    members.sync += node.flexray->pKeySlotUsedForSync ? 1 : 0;
    members.startup += node.flexray->pKeySlotUsedForStartup ? 1 : 0;
  }
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    const model::Node& node = cluster.nodes[n];
    check_rules(kNodeRules, node, fmt::format("nodes.{}.", node.name), findings);
    if (!node.flexray) continue;
    const std::string path = fmt::format("nodes.{}.flexray.", node.name);
    check_constraints(Constraint::On::kController,
                      {cluster, *node.flexray, analysis::worst_drift_ppb(node), worst_drift}, path, findings);
    check_rules(kControllerRules, Controller{cluster, static_cast<NodeId>(n)}, path, findings);
  }
  check_rules(kClusterRules, members, "", findings);
}

}  // namespace ttf::schedules::check
