// Simulated radars in a whole cluster, from echoes to images, in each weather and with blind sides.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "core/yaml_edit.h"
#include "sim/drives/known_fields.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives {
namespace {

using fusion::oosm::Kind;
using fusion::strategies::StrategyKind;

constexpr const char* kRadars = "scenarios/laser_and_radar.yaml";

evaluation::accuracy::DriveSummary measured(const Drive& drive) {
  evaluation::accuracy::DriveMeasures measures(evaluation_start(drive.scenario));
  drive.run(measures);
  return measures.finish();
}

class RadarDrive : public testing::TestWithParam<StrategyKind> {};
INSTANTIATE_TEST_SUITE_P(Strategies, RadarDrive, testing::ValuesIn(fusion::strategies::kAllStrategies),
                         [](const auto& strategy) { return std::string(name_of(strategy.param)); });

TEST_P(RadarDrive, FollowsAllThreeCars) {
  const evaluation::accuracy::DriveSummary summary = measured(Drive(kRadars, GetParam()));
  EXPECT_LT(summary.missed, summary.matched / 20);
  EXPECT_LT(summary.position_rmse_truth, 1.0);
  EXPECT_LT(summary.velocity_rmse_truth, 1.0);
  EXPECT_GT(summary.own.innovations, 0.6);
  EXPECT_LT(summary.own.innovations, 1.3);
}

// The laser sees one metre.
TEST_P(RadarDrive, FollowsThemByRadarAlone) {
  Drive drive(kRadars, GetParam());
  drive.scenario.sensors.of<sensors::laser::Kind>().usual.model.max_range_m = 1.0;
  const evaluation::accuracy::DriveSummary summary = measured(drive);
  EXPECT_LT(summary.missed, summary.matched / 10);
  EXPECT_LT(summary.position_rmse_truth, 2.0);
  EXPECT_GT(summary.own.innovations, 0.4);  // judged with too much care: docs/fusion/radar.md
  EXPECT_LT(summary.own.innovations, 1.3);
}

// Counts the observations of each sensor.
class Observations final : public recording::records::Sink {
 public:
  using recording::records::Sink::on;
  void on(const recording::records::ObservationSeen& seen) override { ++of[index_of(seen.id.sensor)]; }
  std::array<int, 8> of{};
};

std::string switched_off(const std::string& text, const std::vector<std::string>& sensors) {
  std::string edited = text;
  for (const std::string& sensor : sensors)
    edited = with_value(edited, "four_kinds.yaml", "sensors." + sensor + ".enabled", "false");
  return edited;
}

// Their lists are empty, in any weather, and the tracker expects nothing of them.
TEST(SwitchedOff, SensorsOfEveryKindMeasureNothing) {
  const Drive whole("scenarios/four_kinds.yaml", StrategyKind::kAdva);
  const std::vector<std::string> sensors{"laser", "mono_camera", "stereo_camera", "radar"};
  for (std::size_t on = 0; on < sensors.size(); ++on) {
    std::vector<std::string> off = sensors;
    off.erase(off.begin() + static_cast<std::ptrdiff_t>(on));
    Drive drive = whole;
    drive.scenario =
        parse_scenario(with_value(switched_off(whole.scenario.text, off), "four_kinds.yaml", "world.weather", "rain"),
                       whole.scenario.file);
    drive.scenario.duration = Duration::milliseconds(1000);
    const fusion::config::TrackerConfig tracker = tracker_of(drive.scenario, drive.cluster);
    Observations seen;
    drive.run(seen);
    for (std::size_t s = 0; s < sensors.size(); ++s) {
      const auto id = index_of(*drive.cluster.find_sensor(sensors[s]));
      EXPECT_EQ(seen.of[id] > 0, s == on) << sensors[s] << ", with " << sensors[on] << " alone";
      EXPECT_EQ(tracker.sensors[id].field->max_range > 0.0, s == on) << sensors[s];
    }
  }
}

TEST(RadarLate, EveryMethodIsNearlyRewinding) {
  Drive drive(kRadars, StrategyKind::kAdva);
  drive.scenario.duration = Duration::milliseconds(4000);
  const evaluation::accuracy::DriveSummary rewinding = measured(drive);
  EXPECT_GE(rewinding.fused_late, 2u);
  for (const Kind kind : {Kind::kAugmented, Kind::kAdjoint, Kind::kAl1, Kind::kBl1, Kind::kA, Kind::kB, Kind::kC}) {
    drive.scenario.tracker.late = kind;
    check_late(drive.scenario, drive.cluster, StrategyKind::kAdva);
    const evaluation::accuracy::DriveSummary other = measured(drive);
    EXPECT_NEAR(other.position_rmse_truth / rewinding.position_rmse_truth, 1.0, 0.1) << name_of(kind);
    EXPECT_NEAR(other.velocity_rmse_truth / rewinding.velocity_rmse_truth, 1.0, 0.1) << name_of(kind);
  }
}

TEST(RadarLate, ClonesTakeThemOnASchedule) {
  Drive drive(kRadars, StrategyKind::kTt);
  const evaluation::accuracy::DriveSummary rewinding = measured(drive);
  drive.scenario.tracker.late = Kind::kClone;
  check_late(drive.scenario, drive.cluster, StrategyKind::kTt);
  const evaluation::accuracy::DriveSummary clone = measured(drive);
  EXPECT_NEAR(clone.position_rmse_truth / rewinding.position_rmse_truth, 1.0, 0.02);
}

Scenario changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos);
  return parse_scenario(text.replace(at, from.size(), to), shipped(kRadars));
}

TEST(RadarScenario, TheTrackerHasSpansFieldsAndBlindSides) {
  const Scenario scenario = load_scenario(shipped(kRadars));
  const Scenario fog = changed(scenario.text, "weather: clear", "weather: fog");
  const Scenario hidden =
      changed(scenario.text, "half_field: 1.0", "half_field: 1.0\n    blind: [{from: -0.9, to: -0.7}]");
  const schedules::model::Cluster cluster =
      schedules::file::load_cluster(scenario.cluster_files[static_cast<std::size_t>(StrategyKind::kTt)]);
  const auto known = [&](const Scenario& of, const char* name) {
    return tracker_of(of, cluster).sensors[index_of(*cluster.find_sensor(name))];
  };
  EXPECT_EQ(known(scenario, "radar").range_rate_span, 160.0);
  EXPECT_EQ(known(scenario, "corner_radar").range_rate_span, 60.0);
  EXPECT_EQ(known(scenario, "radar").resolution->rate_span_mps, 160.0);
  EXPECT_EQ(known(scenario, "corner_radar").resolution->across_m, 2.5);
  EXPECT_FALSE(known(scenario, "laser").resolution);
  EXPECT_EQ(known(scenario, "corner_radar").field->half_angle, 1.0);
  EXPECT_EQ(known(scenario, "radar").field->shadow, 0.0);
  EXPECT_EQ(known(scenario, "laser").field->max_range, 120.0);
  EXPECT_EQ(known(fog, "laser").field->max_range, 48.0);
  EXPECT_EQ(known(scenario, "corner_radar").field->blind_sectors, 0u);
  ASSERT_EQ(known(hidden, "corner_radar").field->blind_sectors, 1u);
  EXPECT_EQ(known(hidden, "corner_radar").field->blind[0].from, -0.9);
}

}  // namespace
}  // namespace ttf::sim::drives
