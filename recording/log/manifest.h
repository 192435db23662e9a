// What a log says about itself: which run it is of, and the names that its numbers stand for, so that readers
// can label lanes and curves without loading the cluster.
#pragma once

#include <array>
#include <cstddef>
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

// The kinds of record, in the order of records::Sink. Values are MCAP channel and schema ids and go into the
// content hash: append only.
enum class RecordKind : std::uint8_t {
  kMeasured = 1,
  kCanFrame,
  kSlotFrame,
  kSlotProblem,
  kListHop,
  kTaskRun,
  kClockCorrected,
  kPrecision,
  kFusionInput,
  kListFused,
  kFusionStep,
  kTrack,
  kObservation,
  kImage,
  kFeature,
  kReference,
  kTruth,
  kStateChange,
  kSymbol,
  kPower,
  kFault,
  kGuardian,
  kChannelFrame,
  kTimingProblem,
  kLateness,
  kMedium,
};
inline constexpr std::size_t kRecordKinds = 26;

// What is not of the run but of the machine it ran on, or of one who sees all clocks, which a node set of separate
// processes has not: it does not count in the content hash.
constexpr bool counts_in_hash(RecordKind kind) {
  return kind != RecordKind::kPrecision && kind != RecordKind::kTimingProblem && kind != RecordKind::kLateness &&
         kind != RecordKind::kMedium;
}

// Topic of each kind, by value - 1.
inline constexpr std::array<std::string_view, kRecordKinds> kTopics{
    "/measured",  "/can_frame",     "/slot_frame",     "/slot_problem", "/list_hop", "/task_run",    "/clock_corrected",
    "/precision", "/fusion_input",  "/list_fused",     "/fusion_step",  "/track",    "/observation", "/image",
    "/feature",   "/reference",     "/truth",          "/state_change", "/symbol",   "/power",       "/fault",
    "/guardian",  "/channel_frame", "/timing_problem", "/lateness",     "/medium"};

constexpr std::string_view topic_of(RecordKind kind) { return kTopics[static_cast<std::size_t>(kind) - 1]; }

}  // namespace ttf::recording::log
