// A vehicle that turns at 30 km/h past a parked car, in whole drives: odometry on the bus, tracks over ground.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/file_bytes.h"
#include "evaluation/accuracy/drive_measures.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;

// The parked car alone, until the vehicle passes it.
Drive past_a_parked_car(StrategyKind kind, const std::string& faults = {}) {
  const std::string file = shipped("scenarios/turning_ego.yaml");
  Drive drive("scenarios/turning_ego.yaml", kind);
  drive.scenario = parse_scenario(read_file(file) + faults, file);
  drive.scenario.world.objects.resize(1);
  drive.scenario.duration = Duration::milliseconds(3800);
  return drive;
}

class TurningEgo : public testing::TestWithParam<StrategyKind> {};
INSTANTIATE_TEST_SUITE_P(All, TurningEgo, testing::Values(StrategyKind::kBuff, StrategyKind::kAdva, StrategyKind::kTt));

TEST_P(TurningEgo, AParkedCarStands) {
  const evaluation::accuracy::DriveSummary summary = summary_of(past_a_parked_car(GetParam()));
  EXPECT_GT(summary.odometry_samples, 150u);
  EXPECT_EQ(summary.odometry_stops, 0u);
  EXPECT_GT(summary.matched, 50u);
  EXPECT_EQ(summary.missed, 0u);
  EXPECT_EQ(summary.spurious, 0u);
  EXPECT_LT(std::hypot(summary.rmse_truth[0], summary.rmse_truth[1]), 0.15) << "[m]";
  EXPECT_LT(std::hypot(summary.rmse_truth[2], summary.rmse_truth[3]), 0.6) << "[m/s]; the vehicle drives at 8.3";
  EXPECT_LT(summary.nees, 4.0);
}

// The node of the odometry has no supply for 600 ms: the fusion says that odometry has stopped, and coasts.
TEST_P(TurningEgo, OdometryThatStopsIsReportedAndCoasted) {
  const evaluation::accuracy::DriveSummary sound = summary_of(past_a_parked_car(GetParam()));
  const evaluation::accuracy::DriveSummary summary = summary_of(past_a_parked_car(
      GetParam(), "faults:\n  - {kind: crash, node: odometry_pre, from: 2500 ms, duration: 600 ms}\n"));
  EXPECT_EQ(summary.odometry_stops, 1u);
  EXPECT_LT(summary.odometry_samples + 25, sound.odometry_samples);
  EXPECT_GT(summary.odometry_samples, 100u);
  EXPECT_EQ(summary.matched, sound.matched);
  EXPECT_EQ(summary.spurious, 0u);
  EXPECT_LT(std::hypot(summary.rmse_truth[2], summary.rmse_truth[3]), 0.6);
  EXPECT_LT(summary.nees, 4.0);
}

// Odometry that the fusion does not read does not hold its lists back: tracks are relative to the vehicle.
TEST(TurningEgoUnread, ListsAreFusedWithoutOdometry) {
  Drive drive = past_a_parked_car(StrategyKind::kTt);
  for (schedules::model::Node& node : drive.cluster.nodes)
    for (schedules::model::Task& task : node.tasks)
      if (task.step == "fusion") std::erase_if(task.reads, [](const auto& read) { return read.port == "odometry"; });
  const evaluation::accuracy::DriveSummary summary = summary_of(drive);
  EXPECT_EQ(summary.odometry_samples, 0u);
  EXPECT_GT(summary.matched, 40u);
}

}  // namespace
}  // namespace ttf::sim::drives
