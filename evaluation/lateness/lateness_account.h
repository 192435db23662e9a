// The account of a drive by the wall clock, in its machine's time, from its records alone. It has the lateness
// of processes and frames, next to that of a plain thread on the same machine; late, early and lost frames; the
// media's counts; and the clocks' agreement. DriveSummary (evaluation/accuracy/drive_measures.h) has the ages
// at the uses of the feature service.
//
// Lateness is in real time already. Differences of the records' times are in the drive's time, which a
// stretched drive (--time-scale) multiplies: see in_real_time().
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/lateness/achieved_precision.h"
#include "evaluation/lateness/missing_frames.h"
#include "recording/exports/lateness_sums.h"
#include "recording/merge/merge.h"
#include "recording/records/binned_durations.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::lateness {

// Sums the counts of a drive's live media, node by node, from its logs.
//
// A record counts from the start of its process, so the newest one suffices. If a count or the local time
// decreases, the node has a new process; the last record of the old one then joins the sum.
class MediumSums final : public recording::records::Sink {
 public:
  // Returns the nodes with counts, by id; empty in virtual time. The stamp is that of the newest record.
  std::map<NodeId, recording::records::MediumCounts> nodes() const;

  using recording::records::Sink::on;
  void on(const recording::records::MediumCounts&) override;

 private:
  struct Reported {
    recording::records::MediumCounts before;  // from the node's former processes
    recording::records::MediumCounts newest;  // from its present process
  };
  std::map<NodeId, Reported> reported_;
};

// Facts about the drive from the logs' manifests.
struct RealTimeDrive {
  std::int64_t time_scale_ppm = 1'000'000;  // recording::LogManifest
  std::map<NodeId, std::string> hosts;      // the machine of each node; a node without one is not compared
};
RealTimeDrive real_time_drive(const recording::merge::MergedLogs& logs);

// Rounded towards zero; a value beyond the type becomes its limit.
Duration in_real_time(Duration of_the_drive, std::int64_t time_scale_ppm);

struct NodeTiming {
  std::uint64_t late_wake_ups = 0;
  std::uint64_t slots_missed = 0;
  std::uint64_t late_frames = 0;
  std::uint64_t early_frames = 0;
  std::uint64_t frames_lost = 0;  // never came
  MissingFramesCount missing;     // these, by their senders' logs
  std::uint64_t lost_on_the_way() const { return frames_lost - missing.withheld - missing.away; }
  // By size, in real time; absent if the node's clock was never corrected.
  std::optional<Duration> largest_offset_correction;
};

struct HostPrecision {
  std::string host;
  recording::records::BinnedDurations
      apart;  // largest difference of two nodes' clocks, by instants; in the drive's time
};

struct RealTimeFindings {
  std::int64_t time_scale_ppm = 1'000'000;
  std::map<NodeId, recording::exports::NodeLateness> lateness;  // for nodes with histograms
  std::map<NodeId, NodeTiming> timing;                          // for nodes with such records, corrections or problems
  std::map<NodeId, recording::records::MediumCounts> medium;    // for nodes with counts
  std::vector<HostPrecision> precision;                         // for machines with two synchronised nodes or more, by
                                                                // name

  std::uint64_t frames_lost() const;
  std::uint64_t late_frames() const;
};

class LatenessAccount final : public recording::records::Sink {
 public:
  LatenessAccount(const schedules::model::Cluster& cluster, RealTimeDrive drive);

  // Returns the findings; absent if no record is of real time. Call it once, at the end.
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
  RealTimeDrive drive_;
  bool any_ = false;  // a record of real time
  recording::exports::LatenessSums sums_;
  MediumSums medium_;
  MissingFrames missing_;
  std::map<NodeId, NodeTiming> timing_;
  std::map<std::string, AchievedPrecision> by_host_;
};

}  // namespace ttf::evaluation::lateness
