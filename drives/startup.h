// How a drive begins: with all nodes integrated, or cold, each node when its supply comes.
//
//   startup: integrated                     # or left out: cycle 0 starts with the drive, and every node is in it
//   startup:
//     kind: cold
//     spread: 20 ms                         # supplies come at a drawn time 0..spread from the start of the drive on,
//     power_on: {fusion: 0 ms, gateway: 12 ms}   # or when it says here
//     wake_up: fusion                       # this node wakes the cluster first (left out: nobody needs to be woken)
//
// With `wake_up`, the named node sends a wake-up pattern on its wake-up channel before it starts up. Every other node
// on that channel sleeps: its supply is there from the start of the drive on, but its controller and host are off until
// it hears the pattern, and its power-on time counts from then. Nodes on the other channel only, or off FlexRay, nobody
// can wake: their power-on times count from the start of the drive.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "nodes/host/cold_start.h"
#include "schedules/model/cluster.h"

namespace ttf::drives {

struct Startup {
  bool cold = false;
  Duration spread = Duration::milliseconds(20);
  struct PowerOn {
    std::string node;
    Duration after{};
    int line = 0;
  };
  std::vector<PowerOn> power_on;
  std::string wake_up;  // empty: nobody
  std::string file;     // for messages
  int wake_up_line = 0;
};

// The key `startup` of a scenario, and what goes without it; nothing comes later than `latest`. Findings are the
// mapping's.
Startup load_startup(YamlMap& scenario, Duration latest);

// Of every node of the cluster, drawn where the scenario leaves it open. Throws InputError with every finding: names
// nobody has, a node that wakes without FlexRay, or whose wake-up channel it is not attached to.
std::vector<nodes::host::NodeStart> node_starts(const Startup& startup, const schedules::model::Cluster& cluster,
                                                std::uint64_t seed, std::uint32_t replication);

}  // namespace ttf::drives
