// What a log says about itself: which run it is of, and the names that its numbers stand for, so that readers
// can label lanes and curves without loading the cluster.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/ids.h"

namespace ttf::recording::log {

// `hashes` are (what, hex digits) pairs, e.g. ("cluster", "6f0c..."); names are unique. The name lists are
// indexed by NodeId, (NodeId, task), PduId, SensorId and the index in Cluster::can_buses.
struct LogManifest {
  std::string version;  // of the program that wrote the log
  std::uint64_t seed = 0;
  std::string scenario_name;
  std::string cluster_name;
  std::string strategy;
  std::string recording_name;  // file of the recorded observations the run was fed with; empty: none
  std::int64_t cycle_ns = 0;   // nominal communication cycle, for the grid of diagrams; 0 if unknown
  std::int64_t bit_ps = 0;     // nominal bit on FlexRay, for symbols' lengths; 0 if unknown
  std::vector<std::pair<std::string, std::string>> hashes;
  std::vector<std::string> node_names;
  std::vector<std::vector<std::string>> task_names;  // per node, in the order of Node::tasks
  std::vector<std::string> pdu_names;
  std::vector<SensorId> pdu_sensors;  // whose measurements the PDU's lists descend from; kNoSensor: of none
  std::vector<std::string> sensor_names;
  std::vector<std::string> can_bus_names;
  std::string clock;                        // empty: true times are the simulator's; else as below
  std::string host;                         // on which the log was written, where its clock is the wall's
  std::int64_t time_scale_ppm = 1'000'000;  // real time was so much longer than the drive's (--time-scale); in virtual
                                            // time always 1

  bool operator==(const LogManifest&) const = default;
};

// True times are what the clock of the process' host showed since the run was to start, in the drive's time; after a
// merge of several hosts' logs, on the one scale that they were put on (recording/merge/common_time.h).
inline constexpr std::string_view kWallClock = "wall", kCommonClock = "common";

}  // namespace ttf::recording::log
