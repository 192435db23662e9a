// The description of a log: its drive, and the names behind its numbers. Readers can label lanes and curves
// without loading the cluster.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/ids.h"
#include "recording/log/sensor_style.h"
#include "schedules/model/round.h"

namespace ttf::recording::log {

// `hashes` are pairs of a name and hex digits, e.g. ("cluster", "6f0c..."); names are unique. The name lists
// are indexed by NodeId, (NodeId, task), PduId, SensorId and the index in Cluster::can_buses.
struct LogManifest {
  std::string version;  // the version that wrote the log
  std::uint64_t seed = 0;
  std::string scenario_name;
  std::string cluster_name;
  std::string strategy;
  std::string recording_name;                  // file of the recorded observations that fed the drive; empty: none
  std::string truth_name;                      // trace of another simulator that was the drive's world; empty: none
  std::int64_t cycle_ns = 0;                   // nominal communication cycle, for the grid of diagrams; 0 if unknown
  int cycles = schedules::model::kMostCycles;  // values of the cycle counter
  std::int64_t bit_ps = 0;                     // nominal bit on FlexRay, for symbols' lengths; 0 if unknown
  std::vector<std::pair<std::string, std::string>> hashes;
  std::vector<std::string> node_names;
  std::vector<std::vector<std::string>> task_names;  // per node, in the order of Node::tasks
  std::vector<std::string> pdu_names;
  std::vector<SensorId> pdu_sensors;  // the sensor of the PDU's measurements; kNoSensor: no single one
  std::vector<std::string> sensor_names;
  std::vector<SensorStyle> sensor_styles;  // by SensorId, up to the last one that the scenario styles
  std::vector<std::string> can_bus_names;
  std::string clock;                        // empty: true times are the simulator's; else as below
  std::string host;                         // machine that wrote the log, if its clock is the wall's
  std::int64_t time_scale_ppm = 1'000'000;  // real time per time of the drive, in ppm (--time-scale); in virtual time
                                            // always 1'000'000

  bool operator==(const LogManifest&) const = default;
};

// True times of a drive in real time: those of the machine's clock since the start of the drive, in the drive's
// time. After a merge of several machines' logs: those of the common scale (recording/merge/common_time.h).
inline constexpr std::string_view kWallClock = "wall", kCommonClock = "common";

}  // namespace ttf::recording::log
