// Shipped drives whose fusion takes late lists in by another method than rewinding.
#include <gtest/gtest.h>

#include <string>

#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives {
namespace {

using fusion::oosm::Kind;
using fusion::strategies::StrategyKind;

constexpr const char* kScenario = "scenarios/paper_scenario1.yaml";

// Methods for single states are for straight motion: the defaults.
Drive straight_drive(const char* scenario, StrategyKind strategy) {
  Drive drive(scenario, strategy);
  drive.scenario.tracker = {};
  return drive;
}

// Errors agree within some per cent, objects and lists exactly.
void expect_nearly(const evaluation::accuracy::DriveSummary& other,
                   const evaluation::accuracy::DriveSummary& rewinding) {
  EXPECT_NEAR(other.position_rmse_truth / rewinding.position_rmse_truth, 1.0, 0.02);
  EXPECT_NEAR(other.velocity_rmse_truth / rewinding.velocity_rmse_truth, 1.0, 0.02);
  EXPECT_NEAR(other.nees / rewinding.nees, 1.0, 0.05);
  EXPECT_EQ(other.missed, 0u);
  EXPECT_EQ(other.matched, rewinding.matched);
  EXPECT_EQ(other.received, rewinding.received);
  EXPECT_EQ(other.out_of_sequence, rewinding.out_of_sequence);
  // Before the first track, a late list is dropped.
  EXPECT_EQ(other.fused_late + other.dropped, rewinding.fused_late + rewinding.dropped);
  EXPECT_LE(other.dropped, 2u);
}

// Few lists are late with one object. With 25, later lists are frequent.
TEST(LateMethod, AdvaWithOthersIsNearlyRewinding) {
  for (const char* scenario : {kScenario, "scenarios/crowd_25.yaml"}) {
    Drive drive = straight_drive(scenario, StrategyKind::kAdva);
    const evaluation::accuracy::DriveSummary rewinding = summary_of(drive);
    EXPECT_GE(rewinding.fused_late, scenario == kScenario ? 2u : 100u);
    for (const Kind kind : {Kind::kAugmented, Kind::kAdjoint, Kind::kAl1}) {
      drive.scenario.tracker.late = kind;
      SCOPED_TRACE(std::string(scenario) + ", " + std::string(name_of(kind)));
      expect_nearly(summary_of(drive), rewinding);
    }
  }
}

// The schedule has the sensors' instants. The camera measures 25 ms later than in the shipped cluster, so
// that its lists overtake the laser's.
TEST(LateMethod, AdvaWithClonesIsNearlyRewinding) {
  Drive drive = straight_drive(kScenario, StrategyKind::kTt);
  drive.strategy = StrategyKind::kAdva;
  for (schedules::model::Sensor& sensor : drive.cluster.sensors)
    if (sensor.kind == schedules::model::SensorKind::kCamera) sensor.at.base_cycle = 6;
  const evaluation::accuracy::DriveSummary rewinding = summary_of(drive);
  EXPECT_GT(rewinding.fused_late, 30u);
  drive.scenario.tracker.late = Kind::kClone;
  expect_nearly(summary_of(drive), rewinding);
}

// Sensors that follow their hosts: each list is fused on arrival, one in six late. Their next measurement is
// unknown.
TEST(LateMethod, WhereSensorsFollowTheirHostsAllButClonesAreNearlyRewinding) {
  for (const char* cluster : {"schedules/paper_free_running.yaml", "schedules/paper_free_flexray.yaml"}) {
    Drive drive = straight_drive(kScenario, StrategyKind::kAdva);
    drive.cluster = schedules::file::load_cluster(shipped(cluster));
    const evaluation::accuracy::DriveSummary rewinding = summary_of(drive);
    EXPECT_GT(rewinding.fused_late, 20u);
    for (const Kind kind : {Kind::kAugmented, Kind::kAdjoint, Kind::kAl1, Kind::kBl1}) {
      drive.scenario.tracker.late = kind;
      SCOPED_TRACE(std::string(cluster) + ", " + std::string(name_of(kind)));
      expect_nearly(summary_of(drive), rewinding);
    }
    drive.scenario.tracker.late = Kind::kClone;
    EXPECT_THROW(summary_of(drive), InputError);
  }
}

TEST(LateMethod, TimeTriggeredClonesAreNeverNeeded) {
  Drive drive = straight_drive(kScenario, StrategyKind::kTt);
  const evaluation::accuracy::DriveSummary rewinding = summary_of(drive);
  drive.scenario.tracker.late = Kind::kClone;
  const evaluation::accuracy::DriveSummary clones = summary_of(drive);
  EXPECT_EQ(clones.fused_late, 0u);
  EXPECT_EQ(clones.position_rmse_truth, rewinding.position_rmse_truth);
  EXPECT_EQ(clones.nees, rewinding.nees);
}

TEST(LateMethod, BuffAlwaysRewinds) {
  Drive drive = straight_drive(kScenario, StrategyKind::kBuff);
  const evaluation::accuracy::DriveSummary rewinding = summary_of(drive);
  drive.scenario.tracker.late = Kind::kC;
  EXPECT_EQ(summary_of(drive).position_rmse_truth, rewinding.position_rmse_truth);
}

TEST(LateMethod, AMethodThatTheStrategyHasNotIsRefusedBeforeTheDrive) {
  Drive drive = straight_drive(kScenario, StrategyKind::kTt);
  drive.scenario.tracker.late = Kind::kAl1;
  try {
    summary_of(drive);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    ASSERT_EQ(error.findings().size(), 1u);
    EXPECT_NE(error.findings()[0].sentence().find("tracker.late = al1: must be rewind or clone with strategy tt"),
              std::string::npos)
        << error.findings()[0].sentence();
  }
}

}  // namespace
}  // namespace ttf::sim::drives
