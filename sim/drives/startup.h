// The beginning of a drive: with all nodes integrated, or cold, with a power-on time for each node.
//
//   startup: integrated                     # or left out: cycle 0 starts with the drive, and every node is in it
//   startup:
//     kind: cold
//     spread: 20 ms                         # power-on times are drawn in 0..spread from the start of the drive,
//     power_on: {fusion: 0 ms, gateway: 12 ms}   # or set here
//     wake_up: fusion                       # this node wakes the cluster first (left out: no node sleeps)
//
// With `wake_up`, the named node sends a wake-up pattern on its wake-up channel before it starts up. Every other
// node on that channel sleeps. Its supply is on from the start of the drive, but its controller and host are off
// until it receives the pattern. Its power-on time counts from then. Nodes only on the other channel or off FlexRay
// do not sleep: their power-on times count from the start of the drive.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "nodes/host/cold_start.h"
#include "schedules/model/cluster.h"

namespace ttf::sim::drives {

struct Startup {
  bool cold = false;
  Duration spread = Duration::milliseconds(20);
  struct PowerOn {
    std::string node;
    Duration after{};
    int line = 0;
  };
  std::vector<PowerOn> power_on;
  std::string wake_up;  // empty: no node
  std::string file;     // for messages
  int wake_up_line = 0;
};

// Reads the key `startup` of a scenario and its defaults; no power-on may be later than `latest`. Findings go to
// the mapping.
Startup load_startup(YamlMap& scenario, Duration latest);

// Returns the start of every node of the cluster, drawn where the scenario sets no time. Throws InputError with
// every finding: unknown names, a waking node off FlexRay or without its wake-up channel.
std::vector<nodes::host::NodeStart> node_starts(const Startup& startup, const schedules::model::Cluster& cluster,
                                                std::uint64_t seed, std::uint32_t replication);

}  // namespace ttf::sim::drives
