// What a run by the wall clock was like in its machine's time, from its records alone: how late processes and frames
// were, next to a plain thread's lateness on the same machine; what was not in its time, or never came, and what the
// media counted; how well the clocks agreed. How old what the feature service used was is in DriveSummary
// (evaluation/accuracy/drive_measures.h).
//
// Lateness is in real time already. Differences of the records' times are in the drive's, which a stretched run
// (--time-scale) takes so much longer for: in_real_time().
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/lateness/achieved_precision.h"
#include "evaluation/lateness/medium_sums.h"
#include "evaluation/lateness/missing_frames.h"
#include "recording/exports/lateness_sums.h"
#include "recording/merge/merge.h"
#include "recording/records/binned_durations.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::lateness {

// What the logs say of the run, beside records.
struct RealTimeRun {
  std::int64_t time_scale_ppm = 1'000'000;  // recording::LogManifest
  std::map<NodeId, std::string> hosts;      // where each node ran; who is not in it is not compared
};
RealTimeRun real_time_run(const recording::merge::MergedLogs& logs);

// Rounded towards zero; what its type does not hold is the nearest that it does.
Duration in_real_time(Duration of_the_drive, std::int64_t time_scale_ppm);

struct NodeTiming {
  std::uint64_t late_wake_ups = 0;
  std::uint64_t slots_missed = 0;
  std::uint64_t late_frames = 0;
  std::uint64_t early_frames = 0;
  std::uint64_t frames_lost = 0;  // never came
  MissingFramesCount missing;     // of these: by their senders' logs
  std::uint64_t lost_on_the_way() const { return frames_lost - missing.withheld - missing.away; }
  // Of the node's clock; none if it was never corrected. By size, in real time.
  std::optional<Duration> largest_offset_correction;
};

struct HostPrecision {
  std::string host;
  recording::records::BinnedDurations
      apart;  // largest difference of two nodes' clocks, by instants; in the drive's time
};

struct RealTimeFindings {
  std::int64_t time_scale_ppm = 1'000'000;
  std::map<NodeId, recording::exports::NodeLateness> lateness;  // of nodes that told of any
  std::map<NodeId, NodeTiming> timing;  // of nodes that told of any, were corrected, or had problems
  std::map<NodeId, recording::records::MediumCounts> medium;  // of nodes that told of any
  std::vector<HostPrecision> precision;                       // of hosts with two synchronised nodes or more, by name

  std::uint64_t frames_lost() const;
  std::uint64_t late_frames() const;
};

class LatenessAccount final : public recording::records::Sink {
 public:
  LatenessAccount(const schedules::model::Cluster& cluster, RealTimeRun run);

  // At the end, once. Nothing where no record is of a run in real time.
  std::optional<RealTimeFindings> finish();

  using recording::records::Sink::on;
  void on(const recording::records::TimingProblem&) override;
  void on(const recording::records::SlotFrameSent&) override;
  void on(const recording::records::LatenessHistogram&) override;
  void on(const recording::records::MediumCounts&) override;
  void on(const recording::records::ClockCorrected&) override;

 private:
  bool is_ours(NodeId node) const;

  const schedules::model::Cluster& cluster_;
  RealTimeRun run_;
  bool any_ = false;  // a record of a run in real time
  recording::exports::LatenessSums sums_;
  MediumSums medium_;
  MissingFrames missing_;
  std::map<NodeId, NodeTiming> timing_;
  std::map<std::string, AchievedPrecision> by_host_;
};

}  // namespace ttf::evaluation::lateness
