// Clusters of any size for tests of the protocol alone: 5 ms cycles of 64 static slots and 300 minislots.
// Every node sends a status frame of 16 bytes in its key slot on both channels.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "bus/controller/controller.h"
#include "schedules/model/cluster.h"

namespace ttf::sim::engine {

inline constexpr int kMicroPerCycle = 200'000;  // of 25 ns
// (34 + 20 gClusterDriftDamping) gdMaxMicrotick + 2 gdMaxPropagationDelay: the worst case of FlexRay 2.1A,
// annex B. The damping is 2 here (schedules/check/checker.h).
inline constexpr Duration kAssumedPrecision{(34 + 20 * 2) * 25 + 2 * 2500};

// The first `coldstart` nodes are coldstart nodes, the first `sync` of all are sync nodes.
inline schedules::model::Cluster bus_cluster(int nodes, int coldstart, int sync) {
  schedules::model::Cluster cluster;
  cluster.name = std::to_string(nodes) + " nodes";
  schedules::model::GlobalParameters& g = cluster.flexray;
  g.gPayloadLengthStatic = 8;
  g.gdStaticSlot = 43;  // 2 * 7 + ceil((9 + 1 + 80 + 160 + 2 + 11) * 0.10015 us + 2.5 us)
  g.gNumberOfStaticSlots = 64;
  g.gNumberOfMinislots = 300;
  g.gdNIT = 5000 - 64 * 43 - 4 - 300 * 5;
  g.gOffsetCorrectionStart = 4900;
  g.gSyncNodeMax = std::max(sync, 2);
  for (int n = 0; n < nodes; ++n) {
    schedules::model::Node node;
    node.name = "node" + std::to_string(n);
    node.flexray.emplace();
    schedules::model::NodeParameters& p = *node.flexray;
    p.pMicroPerCycle = kMicroPerCycle;
    p.pKeySlotId = n + 1;
    p.pKeySlotUsedForStartup = n < coldstart;
    p.pKeySlotUsedForSync = n < sync;
    p.pOffsetCorrectionOut = 400;
    p.pRateCorrectionOut = 601;
    p.pDelayCompensationA = p.pDelayCompensationB = 50;
    p.pdAcceptedStartupRange = 400;
    p.pdListenTimeout = 2 * (kMicroPerCycle + 601);
    p.pLatestTx = 280;
    p.pAllowPassiveToActive = 2;
    p.pAllowHaltDueToClock = true;
    cluster.nodes.push_back(std::move(node));
    cluster.frames.push_back({n + 1, schedules::model::Channels::kAB, 0, 1, static_cast<NodeId>(n), kNoPdu, 0, 0});
  }
  return cluster;
}

// A controller's changes of state.
struct StateLog final : bus::controller::ControllerEvents {
  struct Change {
    bus::poc::PocKind from{}, to{};
    bus::poc::PocReason reason{}, consequence{};
    Microticks at{};
    std::int64_t cycle = -1;  // the cycle that started then, if one did
  };
  std::vector<Change> changes;
  void state_changed(bus::poc::PocKind from, const bus::poc::PocStep& step, Microticks at) override {
    changes.push_back({from, step.next.kind, step.reason, step.consequence, at, -1});
  }
  void cycle_started(std::int64_t cycle, Microticks at) override {
    if (!changes.empty() && changes.back().at == at) changes.back().cycle = cycle;
  }
  // The cycle it became normal active in, the last time; -1 if it never did.
  std::int64_t active_in() const {
    for (auto change = changes.rbegin(); change != changes.rend(); ++change)
      if (change->to == bus::poc::PocKind::kNormalActive) return change->cycle;
    return -1;
  }
};

}  // namespace ttf::sim::engine
