#include "evaluation/lateness/lateness_account.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>

#include "core/int128.h"

namespace ttf::evaluation::lateness {
namespace {

using recording::records::MediumCounts;

constexpr std::array<std::uint64_t MediumCounts::*, 7> kCounts{
    &MediumCounts::sent,    &MediumCounts::received,  &MediumCounts::not_sent, &MediumCounts::lost,
    &MediumCounts::foreign, &MediumCounts::malformed, &MediumCounts::dropped};

bool is_of_another_process(const MediumCounts& newer, const MediumCounts& older) {
  return newer.stamp.local < older.stamp.local ||
         std::any_of(kCounts.begin(), kCounts.end(), [&](const auto count) { return newer.*count < older.*count; });
}

void add(MediumCounts& sum, const MediumCounts& more) {
  for (const auto count : kCounts) sum.*count += more.*count;
}

std::uint64_t* counter_of(NodeTiming& timing, recording::records::TimingFault what) {
  using recording::records::TimingFault;
  switch (what) {
    case TimingFault::kLateWakeUp: return &timing.late_wake_ups;
    case TimingFault::kSlotMissed: return &timing.slots_missed;
    case TimingFault::kLateFrame: return &timing.late_frames;
    case TimingFault::kEarlyFrame: return &timing.early_frames;
    case TimingFault::kFramesLost: return &timing.frames_lost;
  }
  return nullptr;  // from a later version
}

std::uint64_t sum_over(const std::map<NodeId, NodeTiming>& timing, std::uint64_t NodeTiming::*count) {
  std::uint64_t sum = 0;
  for (const auto& [node, one] : timing) sum += one.*count;
  return sum;
}

}  // namespace

void MediumSums::on(const MediumCounts& record) {
  Reported& reported = reported_.try_emplace(record.stamp.node, Reported{{}, record}).first->second;
  if (is_of_another_process(record, reported.newest)) add(reported.before, reported.newest);
  reported.newest = record;
}

std::map<NodeId, MediumCounts> MediumSums::nodes() const {
  std::map<NodeId, MediumCounts> nodes;
  for (const auto& [node, reported] : reported_) {
    MediumCounts& sum = nodes[node] = reported.newest;
    add(sum, reported.before);
  }
  return nodes;
}

RealTimeDrive real_time_drive(const recording::merge::MergedLogs& logs) {
  RealTimeDrive drive;
  drive.time_scale_ppm = logs.manifest().time_scale_ppm;
  for (const recording::merge::StoredLog& log : logs.logs())
    for (const recording::merge::SyncStamp& stamp : log.sync_stamps())
      drive.hosts[stamp.node] = log.info().manifest.host;
  return drive;
}

Duration in_real_time(Duration of_the_drive, std::int64_t time_scale_ppm) {
  using Limits = std::numeric_limits<std::int64_t>;
  const Int128 ns = Int128{of_the_drive.ns} * time_scale_ppm / 1'000'000;
  return {static_cast<std::int64_t>(std::clamp<Int128>(ns, Limits::min(), Limits::max()))};
}

std::uint64_t RealTimeFindings::frames_lost() const { return sum_over(timing, &NodeTiming::frames_lost); }
std::uint64_t RealTimeFindings::late_frames() const { return sum_over(timing, &NodeTiming::late_frames); }

LatenessAccount::LatenessAccount(const schedules::model::Cluster& cluster, RealTimeDrive drive)
    : cluster_(cluster), drive_(std::move(drive)), missing_(cluster, drive_.time_scale_ppm) {
  for (const auto& [node, host] : drive_.hosts)
    by_host_.try_emplace(host, cluster.cycle(), cycles_per_round(cluster.flexray));
}

// A log may be of another cluster.
bool LatenessAccount::is_ours(NodeId node) const { return index_of(node) < cluster_.nodes.size(); }

void LatenessAccount::on(const recording::records::TimingProblem& problem) {
  if (!is_ours(problem.stamp.node)) return;
  any_ = true;
  if (std::uint64_t* count = counter_of(timing_[problem.stamp.node], problem.what)) *count += problem.count;
  missing_.add(problem);
}

void LatenessAccount::on(const recording::records::SlotFrameSent& frame) {
  if (is_ours(frame.stamp.node)) missing_.add(frame);
}

void LatenessAccount::on(const recording::records::LatenessHistogram& histogram) {
  if (!is_ours(histogram.stamp.node)) return;
  any_ = true;
  timing_.try_emplace(histogram.stamp.node);
  sums_.on(histogram);
}

void LatenessAccount::on(const recording::records::MediumCounts& counts) {
  if (!is_ours(counts.stamp.node)) return;
  any_ = true;
  timing_.try_emplace(counts.stamp.node);
  medium_.on(counts);
}

void LatenessAccount::on(const recording::records::ClockCorrected& corrected) {
  const NodeId node = corrected.stamp.node;
  if (!is_ours(node)) return;
  const std::int64_t microtick_ps = cluster_.node(node).microtick_ps;
  const std::int64_t microticks = std::abs(std::int64_t{corrected.offset_microticks});
  const Duration by = in_real_time(Duration{microticks * microtick_ps / 1000}, drive_.time_scale_ppm);
  std::optional<Duration>& largest = timing_[node].largest_offset_correction;
  largest = largest ? std::max(*largest, by) : by;
  if (const auto host = drive_.hosts.find(node); host != drive_.hosts.end())
    by_host_.at(host->second).add(corrected.stamp);
}

std::optional<RealTimeFindings> LatenessAccount::finish() {
  if (!any_) return std::nullopt;
  RealTimeFindings findings;
  findings.time_scale_ppm = drive_.time_scale_ppm;
  findings.lateness = sums_.nodes();
  findings.timing = timing_;
  for (const auto& [node, count] : missing_.by_receiver()) findings.timing[node].missing = count;
  findings.medium = medium_.nodes();
  for (auto& [host, precision] : by_host_)
    if (const auto apart = precision.finish(); !apart.empty()) findings.precision.push_back({host, apart});
  return findings;
}

}  // namespace ttf::evaluation::lateness
