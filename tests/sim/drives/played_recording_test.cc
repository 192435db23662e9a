// A recording in a whole drive: played where it was measured, resampled, or refused; and judged while it lasts.
#include "sim/drives/played_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "core/errors.h"
#include "core/file_bytes.h"
#include "evaluation/accuracy/drive_measures.h"
#include "nodes/host/signals.h"
#include "sim/drives/surroundings.h"
#include "sim/engine/cluster_simulation.h"
#include "tests/sim/drives/drive_fixture.h"
#include "tests/support/refusals.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;
using recording::rows::RecordedInput;
using sensors::recorded::RowsArePlayed;
using testing::HasSubstr;

// A car at 5 m/s, seen without noise by laser and radar in turn: a row every 50 ms, then one after `second_us`, and so
// on. It lasts `lasts_us`.
std::shared_ptr<RecordedInput> car(std::int64_t second_us, std::int64_t lasts_us) {
  auto recording = std::make_shared<RecordedInput>();
  recording->name = "m.txt";
  std::int64_t at = 0;
  for (int i = 0; at < lasts_us; at += i % 2 == 0 ? 50'000 : second_us, ++i) {
    const double x = -40.0 + 5e-6 * static_cast<double>(at), y = 3.0;
    recording::rows::RecordedObservation& seen = recording->observations.emplace_back();
    seen.time_us_from_start = at;
    seen.line = i + 1;
    seen.sensor = i % 2 == 0 ? "laser" : "radar";
    seen.x = x;
    seen.y = y;
    if (i % 2 == 1) {
      seen.kind = recording::rows::RecordedObservation::Kind::kRangeBearingRate;
      seen.range = std::hypot(x, y);
      seen.bearing = std::atan2(y, x);
      seen.range_rate = 5.0 * x / seen.range;
    }
    recording->truth.push_back({at, x, y, 5.0, 0.0, 0.0, 0.0});
  }
  return recording;
}

Drive recorded_drive(StrategyKind strategy, RowsArePlayed rows) {
  Drive drive("scenarios/laser_radar_recorded.yaml", strategy);
  drive.scenario.duration = drive.scenario.world.duration = Duration::milliseconds(5'000);
  drive.scenario.recorded_playing.rows = rows;
  return drive;
}

evaluation::accuracy::DriveSummary summary_of(const Drive& drive, const std::shared_ptr<RecordedInput>& recording) {
  const RecordingUse use = recording_use(drive.scenario, drive.cluster, *recording);
  evaluation::accuracy::DriveMeasures measures(evaluation_start(drive.scenario) + Duration::milliseconds(1'000),
                                               evaluation::accuracy::kGate_m, use.end);
  run_drive({&drive.scenario, &drive.cluster, drive.strategy, 1, 0, recording}, measures);
  return measures.finish();
}

TEST(PlayedRecording, OffTheScheduleIsRefusedBeforeTheDrive) {
  const auto recording = car(55'000, 5'000'000);
  for (const StrategyKind strategy : {StrategyKind::kAdva, StrategyKind::kTt}) {
    const Drive drive = recorded_drive(strategy, RowsArePlayed::kAsScheduled);
    try {
      recording_use(drive.scenario, drive.cluster, *recording);
      FAIL() << "rows 50 and 55 ms apart are played at 50 ms";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("m.txt:3: t_us = 105000: must be within 1 ms of an instant"));
    }
    evaluation::accuracy::DriveMeasures none(TrueTime{});
    EXPECT_THROW(run_drive({&drive.scenario, &drive.cluster, strategy, 1, 0, recording}, none), InputError);
  }
}

TEST(PlayedRecording, FreeDevicesPlayItWhereItWasMeasured) {
  const auto recording = car(55'000, 5'000'000);
  for (const StrategyKind strategy : {StrategyKind::kAdva, StrategyKind::kBuff}) {
    const Drive drive = recorded_drive(strategy, RowsArePlayed::kAtTheirStamps);
    const evaluation::accuracy::DriveSummary summary = summary_of(drive, recording);
    EXPECT_GT(summary.matched, 60u);
    EXPECT_EQ(summary.missed, 0u);
    EXPECT_LT(summary.position_rmse_truth, 0.1) << "5 ms a row would be metres after seconds";
    EXPECT_GT(summary.fused + summary.fused_late, 90u);
  }
}

TEST(PlayedRecording, ResampledItFitsEverySchedule) {
  const auto recording = car(55'000, 5'000'000);
  for (const StrategyKind strategy : {StrategyKind::kAdva, StrategyKind::kTt}) {
    const Drive drive = recorded_drive(strategy, RowsArePlayed::kResampled);
    const evaluation::accuracy::DriveSummary summary = summary_of(drive, recording);
    EXPECT_GT(summary.matched, 60u);
    EXPECT_LT(summary.position_rmse_truth, 0.1);
  }
}

TEST(PlayedRecording, OfTheScheduleNothingIsLeftOver) {
  const auto recording = car(50'000, 5'000'000);
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    const Drive drive = recorded_drive(strategy, RowsArePlayed::kAsScheduled);
    EXPECT_EQ(recording_text(recording_use(drive.scenario, drive.cluster, *recording)),
              "laser: 50 rows, 50 lists played\nradar: 50 rows, 50 lists played\n"
              "the recording ended at 4.95 s of 5 s: uses of images and their ages are judged until then\n");
  }
}

TEST(PlayedRecording, RowsBeyondTheDrivesEndAreReported) {
  const Drive drive = recorded_drive(StrategyKind::kTt, RowsArePlayed::kAsScheduled);
  const RecordingUse longer = recording_use(drive.scenario, drive.cluster, *car(50'000, 7'000'000));
  EXPECT_FALSE(longer.ends_early());
  EXPECT_THAT(recording_text(longer),
              HasSubstr("laser: 70 rows, 51 lists played; 19 unused rows beyond the drive's end at 5 s\n"));
  RecordedInput late = *car(50'000, 1'000'000);
  for (auto& row : late.observations) row.time_us_from_start += 6'000'000;
  EXPECT_THROW(recording_use(drive.scenario, drive.cluster, late), InputError);
}

// A device's step; it notes what the laser sent, and when.
struct Received final : nodes::host::Step {
  struct List {
    double since = 0.0, x = 0.0;  // seconds since the recording's time 0, metres
  };
  std::shared_ptr<nodes::host::Step> step;
  TrueTime start;
  std::vector<List>& lists;

  Received(std::shared_ptr<nodes::host::Step> of, TrueTime from, std::vector<List>& into)
      : step(std::move(of)), start(from), lists(into) {}
  void run(nodes::host::StepContext& context) override {
    step->run(context);
    const nodes::host::Output& out = context.outputs[0];
    if (!out.written()) return;
    const auto x = schedules::model::find_signal(out.layout().element, "x");
    lists.push_back({static_cast<double>((context.stamp.true_time - start).ns) * 1e-9,
                     nodes::host::element_value(out.layout(), out.view(), 0, *x)});
  }
};

// The laser's lists. It, or its host, is without supply for 437 ms.
std::vector<Received::List> laser_lists(const Drive& drive, const std::shared_ptr<RecordedInput>& recording,
                                        const char* crashes) {
  const schedules::model::Cluster cluster = cluster_that_plays(drive.scenario, drive.cluster, *recording);
  const Surroundings around = surroundings_of(drive.scenario, cluster, 1, 0, recording);
  const NodeSetConfig nodes{&drive.scenario, &cluster, drive.strategy, 1, 0, around.scene, recording};
  std::vector<Received::List> lists;
  sim::engine::SimulationConfig config;
  config.cluster = &cluster;
  config.seed = 1;
  config.make_steps = [&](NodeId node) {
    auto steps = make_steps(nodes, node);
    if (cluster.node(node).name == "laser")
      steps[0] = std::make_shared<Received>(steps[0], drive_start(cluster), lists);
    return steps;
  };
  recording::records::Tee nowhere({});
  sim::engine::ClusterSimulation simulation(config, nowhere);
  simulation.run_until(TrueTime{1'510'000'000});
  simulation.power_off(*cluster.find_node(crashes));
  simulation.run_until(TrueTime{1'947'000'000});
  simulation.power_on(*cluster.find_node(crashes), simulation.now());
  simulation.run_until(drive_end(drive.scenario));
  return lists;
}

// The car is at -40 m at first and drives at 5 m/s: a row played one period late is half a metre off.
TEST(PlayedRecording, ARestartDoesNotShiftIt) {
  for (const StrategyKind strategy : {StrategyKind::kTt, StrategyKind::kAdva})
    for (const RowsArePlayed rows :
         {RowsArePlayed::kAsScheduled, RowsArePlayed::kAtTheirStamps, RowsArePlayed::kResampled})
      for (const char* crashes : {"laser", "laser_pre"}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(strategy) << static_cast<int>(rows) << crashes);
        const auto lists = laser_lists(recorded_drive(strategy, rows), car(50'000, 5'000'000), crashes);
        for (const Received::List& list : lists) EXPECT_NEAR(list.x, -40.0 + 5.0 * list.since, 0.05) << list.since;
        const auto late = std::count_if(lists.begin(), lists.end(), [](const auto& list) { return list.since > 3.0; });
        EXPECT_GE(late, 18) << "ten a second";
        EXPECT_GE(lists.size(), 40u);
      }
}

Scenario with_noise(const std::string& noise) {
  std::string text = read_file(shipped("scenarios/laser_radar_recorded.yaml"));
  const std::size_t at = text.find("  range_rate: 0.3\n");
  return parse_scenario(text.insert(at, noise), shipped("scenarios/recorded.yaml"));
}

TEST(PlayedRecording, ASensorMayHaveNoiseOfItsOwn) {
  const auto& noises =
      with_noise("  sensors: {laser: {position: 0.1}, radar: {range: 0.2, bearing: 0.01}}\n").recorded_noises;
  EXPECT_EQ(noises.of("laser").position_m, 0.1);
  EXPECT_EQ(noises.of("radar").range_m, 0.2);
  EXPECT_EQ(noises.of("radar").bearing_rad, 0.01);
  EXPECT_EQ(noises.of("radar").range_rate_mps, 0.3) << "as for all";
  EXPECT_EQ(noises.of("other").position_m, 0.15);
}

// The tracker weighs the laser by its own noise. The laser's rows are 0.5 m off along the line of sight, the radar's are
// true. They come in turn, so their weights are their inverse variances. Beside the radar's 0.3 m, 0.15 m gives the laser
// 0.8, and 1.5 m gives it 0.04. The error is 0.4 m, or 0.02 m. A recursion in one dimension with this process noise has
// these figures, too. The mean of the normalised error is 4. It is far above where the tracker trusts the laser.
TEST(PlayedRecording, NoiseOfItsOwnReachesTheLists) {
  const auto recording = car(50'000, 5'000'000);
  for (recording::rows::RecordedObservation& row : recording->observations)
    if (row.sensor == "laser") row.x += 0.5;
  const Drive usual = recorded_drive(StrategyKind::kTt, RowsArePlayed::kAsScheduled);
  Drive own = usual, same = usual;
  own.scenario.recorded_noises.own.push_back({"laser", {1.5, 0.3, 0.03, 0.3}, 0});
  same.scenario.recorded_noises.own.push_back({"laser", usual.scenario.recorded_noises.usual, 0});
  const auto as_usual = summary_of(usual, recording), as_own = summary_of(own, recording);
  EXPECT_NEAR(as_usual.rmse_truth[0], 0.4, 0.04);
  EXPECT_NEAR(as_own.rmse_truth[0], 0.02, 0.02);
  EXPECT_GT(as_usual.nees, 15.0);
  EXPECT_LT(as_own.nees, 4.0);
  EXPECT_EQ(as_usual.nees, summary_of(same, recording).nees);
}

TEST(PlayedRecording, NoiseOfNoSensorIsRefused) {
  const schedules::model::Cluster cluster = schedules::file::load_cluster(shipped("schedules/laser_radar.yaml"));
  const auto refusal = [&](const std::string& noise) -> std::string {
    return support::refusal_of([&] { check_recording(with_noise(noise), cluster, true); });
  };
  EXPECT_EQ(refusal(""), "");
  EXPECT_EQ(refusal("  sensors: {radar: {range: 0.2}}\n"), "");
  EXPECT_THAT(refusal("  sensors: {lasr: {position: 0.2}}\n"),
              HasSubstr("recorded.sensors.lasr: must be a sensor of "));
  EXPECT_THAT(refusal("  sensors: {lasr: {position: 0.2}}\n"),
              HasSubstr(" that plays the recording: laser or radar; did you mean laser?"));
  EXPECT_THAT(refusal("  sensors: {laser: {position: 0}}\n"),
              HasSubstr("recorded.sensors.laser.position = 0: must be a number 0.001..4 m"));
}

TEST(PlayedRecording, AgesAreJudgedWhileItLasts) {
  const Drive drive = recorded_drive(StrategyKind::kAdva, RowsArePlayed::kAsScheduled);
  const auto recording = car(50'000, 3'000'000);
  const evaluation::accuracy::DriveSummary summary = summary_of(drive, recording);
  EXPECT_GT(summary.uses, 30u);
  EXPECT_LT(summary.age_used.worst, Duration::milliseconds(400)) << "the last 2 s have no measurements";
  EXPECT_THAT(recording_text(recording_use(drive.scenario, drive.cluster, *recording)),
              HasSubstr("the recording ended at 2.95 s of 5 s"));
}

}  // namespace
}  // namespace ttf::sim::drives
