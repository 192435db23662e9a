// Whole drives as Perfetto traces: valid, with every measurement that reaches the feature service.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "recording/exports/perfetto.h"
#include "recording/merge/merge.h"
#include "tests/recording/exports/perfetto_trace.h"
#include "tests/recording/log/log_fixture.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::recording::exports {
namespace {

using sim::drives::Drive;

// The measurements that were the newest of their sensor in a used image; only the first of their images
// counts.
struct Used final : records::Sink {
  using records::Sink::on;
  std::map<std::uint32_t, std::vector<MeasurementId>> first_in;
  std::set<MeasurementId> seen, used;
  std::size_t measurements = 0, runs = 0, can_frames = 0, slot_frames = 0;
  void on(const records::Measured&) override { ++measurements; }
  void on(const records::TaskRun&) override { ++runs; }
  void on(const records::CanFrameSent&) override { ++can_frames; }
  void on(const records::SlotFrameSent&) override { ++slot_frames; }
  void on(const records::ImageWritten& r) override {
    for (const MeasurementId& id : r.newest)
      if (seen.insert(id).second) first_in[r.sequence].push_back(id);
  }
  void on(const records::FeatureUsed& r) override {
    if (!r.stale) used.insert(first_in[r.image_sequence].begin(), first_in[r.image_sequence].end());
  }
};

log::LogManifest manifest_of(const schedules::model::Cluster& cluster) {
  log::LogManifest manifest;
  for (const schedules::model::Node& node : cluster.nodes) {
    manifest.node_names.push_back(node.name);
    manifest.task_names.emplace_back();
    for (const auto& task : node.tasks) manifest.task_names.back().push_back(task.name);
  }
  for (const schedules::model::PduLayout& pdu : cluster.pdus) manifest.pdu_names.push_back(pdu.name);
  for (const schedules::model::Sensor& sensor : cluster.sensors) manifest.sensor_names.push_back(sensor.name);
  for (const auto& bus : cluster.can_buses) manifest.can_bus_names.push_back(bus.name);
  return manifest;
}

struct Exported {
  std::string bytes;
  TraceCounts counts;
  Used used;
};

Exported exported(const std::string& scenario, fusion::strategies::StrategyKind strategy) {
  Drive drive(scenario, strategy);
  const std::string path = log::scratch("drive.mcap");
  {
    log::LogWriter writer(path, manifest_of(drive.cluster));
    drive.run(writer);
    writer.close();
  }
  const merge::MergedLogs log(std::vector<std::string>{path});
  Exported result;
  PerfettoExport trace(LogNames(log.manifest()), [&](std::string_view more) { result.bytes += more; });
  log.read(trace);
  result.counts = trace.finish();
  log.read(result.used);
  return result;
}

class PerfettoDrive : public testing::TestWithParam<fusion::strategies::StrategyKind> {};

TEST_P(PerfettoDrive, EveryUsedMeasurementsWayIsThereFromSensorToFeatureService) {
  const Exported drive = exported("scenarios/paper_scenario1.yaml", GetParam());
  const PerfettoTrace trace(drive.bytes);
  EXPECT_THAT(trace.problems, testing::IsEmpty());
  EXPECT_GT(drive.used.used.size(), 50u);
  std::size_t arrived = 0;
  for (const auto& [flow, through] : trace.flows) {
    EXPECT_EQ(trace.slices[through.front()].lane, "measurements");
    if (trace.slices[through.back()].group != "feature") continue;
    ++arrived;
    std::set<std::string> groups;
    for (const std::size_t slice : through) groups.insert(trace.slices[slice].group);
    EXPECT_TRUE(groups.contains("CAN") && groups.contains("FlexRay") && groups.contains("fusion")) << flow;
    const auto way = trace.way(flow);
    EXPECT_TRUE(std::ranges::any_of(way, [](const auto& stop) { return stop.starts_with("channel A: image"); }))
        << flow;
  }
  EXPECT_EQ(arrived, drive.used.used.size());
  const auto in = [&](std::string_view group) {
    return static_cast<std::size_t>(
        std::ranges::count_if(trace.slices, [&](const auto& s) { return s.group == group; }));
  };
  EXPECT_EQ(in("CAN"), drive.used.can_frames);
  EXPECT_EQ(in("FlexRay"), drive.used.slot_frames);
  EXPECT_EQ(trace.slices.size(), drive.counts.slices + drive.counts.instants);
}
INSTANTIATE_TEST_SUITE_P(Strategies, PerfettoDrive, testing::ValuesIn(fusion::strategies::kAllStrategies));

TEST(PerfettoDrives, AFaultyDriveIsASoundTraceAndTheSameEachTime) {
  const Exported drive = exported("scenarios/faulty_bus.yaml", fusion::strategies::StrategyKind::kTt);
  const PerfettoTrace trace(drive.bytes);
  EXPECT_THAT(trace.problems, testing::IsEmpty());
  EXPECT_TRUE(std::ranges::any_of(trace.slices, [](const auto& s) { return s.group == "faults"; }));
  EXPECT_TRUE(std::ranges::any_of(trace.slices, [](const auto& s) { return s.lane == "slot problems"; }));
  EXPECT_EQ(drive.bytes, exported("scenarios/faulty_bus.yaml", fusion::strategies::StrategyKind::kTt).bytes);
}

}  // namespace
}  // namespace ttf::recording::exports
