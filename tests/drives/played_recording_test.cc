// A recording in a whole drive: played where it was measured, resampled, or refused; and judged while it lasts.
#include "drives/played_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "core/errors.h"
#include "evaluation/accuracy/drive_measures.h"
#include "tests/drives/drive_fixture.h"

namespace ttf::drives {
namespace {

using fusion::strategies::StrategyKind;
using nodes::sensing::RowsArePlayed;
using recording::rows::RecordedInput;
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

TEST(PlayedRecording, WhatIsLeftOverIsTold) {
  const Drive drive = recorded_drive(StrategyKind::kTt, RowsArePlayed::kAsScheduled);
  const RecordingUse longer = recording_use(drive.scenario, drive.cluster, *car(50'000, 7'000'000));
  EXPECT_FALSE(longer.ends_early());
  EXPECT_THAT(recording_text(longer),
              HasSubstr("laser: 70 rows, 51 lists played; 19 unused rows beyond the drive's end at 5 s\n"));
  RecordedInput late = *car(50'000, 1'000'000);
  for (auto& row : late.observations) row.time_us_from_start += 6'000'000;
  EXPECT_THROW(recording_use(drive.scenario, drive.cluster, late), InputError);
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
}  // namespace ttf::drives
