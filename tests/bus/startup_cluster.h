// A small cluster that starts up, for tests that begin with power-on.
#pragma once

#include "tests/bus/bus_rig.h"

namespace ttf::bus {

// small_cluster with `coldstart` coldstart nodes and `others` that only integrate, with sensible design
// parameters.
inline schedules::model::Cluster startup_cluster(int coldstart, int others = 0) {
  schedules::model::Cluster cluster = small_cluster(coldstart + others);
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    schedules::model::NodeParameters& p = *cluster.nodes[n].flexray;
    p.pdAcceptedStartupRange = 400;
    p.pdListenTimeout = 2 * (kMicroPerCycle + 121);
    p.pAllowPassiveToActive = 2;
    p.pAllowHaltDueToClock = true;
    if (n >= static_cast<std::size_t>(coldstart)) p.pKeySlotUsedForStartup = p.pKeySlotUsedForSync = false;
  }
  cluster.flexray.gColdStartAttempts = 8;
  return cluster;
}

constexpr TrueTime at_ms(double ms) { return {static_cast<std::int64_t>(ms * 1e6)}; }

}  // namespace ttf::bus
