// Whole drives with steps of libraries.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "schedules/check/checker.h"
#include "schedules/model/ports.h"
#include "tests/nodes/foreign/one_task.h"
#include "tests/recording/record_text.h"
#include "tests/sim/drives/drive_fixture.h"
#include "tests/support/allocation_counter.h"

namespace ttf::nodes::foreign {
namespace {

using ttf::fusion::strategies::StrategyKind;

std::vector<std::string> records_of(const sim::drives::Drive& drive) {
  recording::TextSink sink;
  sim::drives::DriveConfig config{&drive.scenario, &drive.cluster, drive.strategy, 1, 0, nullptr};
  config.steps = &kSteps;
  sim::drives::run_drive(config, sink);
  return std::move(sink.lines);
}

sim::drives::Drive paper(StrategyKind strategy) {
  sim::drives::Drive drive("scenarios/paper_scenario1.yaml", strategy);
  drive.scenario.duration = Duration::milliseconds(700);
  return drive;
}

void let_libraries_copy(schedules::model::Cluster& cluster) {
  for (schedules::model::Node& node : cluster.nodes)
    for (schedules::model::Task& task : node.tasks)
      if (task.step == "gateway") task.step = "copy.so";
  schedules::model::bind_ports(cluster, sim::drives::step_ports());
}

TEST(ForeignDrive, ACopyLeavesTheRecordsOfTheGateway) {
  for (const StrategyKind strategy : {StrategyKind::kTt, StrategyKind::kAdva}) {
    sim::drives::Drive drive = paper(strategy);
    const std::vector<std::string> expected = records_of(drive);
    ASSERT_GT(expected.size(), 1000u);
    let_libraries_copy(drive.cluster);
    ASSERT_EQ(records_of(drive), expected);
  }
}

sim::drives::Drive example() {
  sim::drives::Drive drive("examples/step/scenario.yaml", StrategyKind::kTt);
  return drive;
}

TEST(ForeignDrive, TheExampleIsSoundAndRepeatable) {
  const sim::drives::Drive drive = example();
  EXPECT_TRUE(schedules::check::check(drive.cluster).empty());
  schedules::model::bind_ports(drive.cluster, sim::drives::step_ports());
  testing::internal::CaptureStderr();
  const std::vector<std::string> first = records_of(drive);
  const std::string lamp = testing::internal::GetCapturedStderr();
  EXPECT_NE(lamp.find(" s: lamp on, nearest object at 14."), std::string::npos) << lamp;
  testing::internal::CaptureStderr();
  EXPECT_EQ(records_of(drive), first);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), lamp);
}

// Counts from the first record on.
struct AllocationsSeen final : recording::records::Sink {
  using recording::records::Sink::on;
  std::optional<std::int64_t> at_start;
  std::int64_t last = 0;
  int runs = 0;
  void on(const recording::records::TaskRun&) override {
    ++runs;
    last = support::allocations();
    if (!at_start) at_start = last;
  }
};

TEST(ForeignDrive, AllocatesNothingOnTheCyclicPath) {
  sim::drives::Drive drive = paper(StrategyKind::kTt);
  let_libraries_copy(drive.cluster);
  AllocationsSeen seen;
  sim::drives::DriveConfig config{&drive.scenario, &drive.cluster, drive.strategy, 1, 0, nullptr};
  config.steps = &kSteps;
  sim::drives::run_drive(config, seen);
  EXPECT_GT(seen.runs, 100);
  EXPECT_EQ(seen.last - seen.at_start.value_or(-1), 0);
}

TEST(ForeignDrive, AClusterFileAloneLoadsNoCode) {
  const sim::drives::Drive drive = example();
  try {
    check_steps(drive.cluster, nullptr);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(error.findings().front().sentence().find("nodes.feature.tasks.warn.step = distance.so: needs --steps"),
              std::string::npos)
        << error.what();
  }
  recording::TextSink none;
  EXPECT_THROW(sim::drives::run_drive({&drive.scenario, &drive.cluster, drive.strategy, 1, 0, nullptr}, none),
               InputError);
}

TEST(ForeignDrive, HashesNameEachLibraryOnce) {
  sim::drives::Drive drive = paper(StrategyKind::kTt);
  EXPECT_TRUE(library_hashes(drive.cluster, &kSteps).empty());
  let_libraries_copy(drive.cluster);
  const auto hashes = library_hashes(drive.cluster, &kSteps);
  ASSERT_EQ(hashes.size(), 1u);
  EXPECT_EQ(hashes[0].first, "copy.so");
  EXPECT_EQ(hashes[0].second.size(), 16u);
  EXPECT_TRUE(library_hashes(drive.cluster, &kSteps, {*drive.cluster.find_node("gateway")}).empty());
}

}  // namespace
}  // namespace ttf::nodes::foreign
