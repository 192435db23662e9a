// A drive that did not do its work with its recording says why, from results made by hand.
#include "cli/drive/recording_outputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ttf::cli::drive {
namespace {

using testing::ElementsAre;

// Two sensors of 100 rows each, all of which were played and fused within 10 s.
StrategyResult sound() {
  StrategyResult result;
  sim::drives::RecordingUse use;
  use.duration = use.ends_after = Duration::milliseconds(10'000);
  for (const char* sensor : {"laser", "radar"}) {
    use.sensors.push_back({sensor, {}});
    use.sensors.back().rows.rows = use.sensors.back().rows.lists = 100;
  }
  result.recording = use;
  result.summary.received = 200;
  result.summary.fused = 190;
  result.summary.fused_late = 10;
  result.made_track = true;
  return result;
}

std::vector<std::string> reasons(const StrategyResult& result, const fusion::config::TrackerConfig& tracker = {}) {
  return recording_reasons(result, tracker);
}

TEST(RecordingReasons, ASoundDriveHasNone) {
  EXPECT_THAT(reasons(sound()), ElementsAre());
  EXPECT_THAT(reasons(StrategyResult{}), ElementsAre()) << "a drive without a recording";
}

TEST(RecordingReasons, RowsOfAllSensorsCountAndHalfIsNotMost) {
  StrategyResult result = sound();
  result.recording->sensors[0].rows.beyond = 60;
  result.recording->sensors[1].rows.beyond = 40;
  EXPECT_THAT(reasons(result), ElementsAre());
  result.recording->sensors[1].rows.beyond = 41;
  EXPECT_THAT(reasons(result), ElementsAre("101 of 200 rows are beyond the drive's end at 10 s"));
}

// A recording of 100 Hz, resampled to 10 Hz.
TEST(RecordingReasons, RowsBetweenTheInstantsAreNoLoss) {
  StrategyResult result = sound();
  for (auto& sensor : result.recording->sensors) sensor.rows.between = 90;
  EXPECT_THAT(reasons(result), ElementsAre());
}

TEST(RecordingReasons, ListsThatWereTooOldAreCountedWithoutDuplicates) {
  StrategyResult result = sound();
  result.summary.duplicates = 50;
  result.summary.dropped = 75;
  EXPECT_THAT(reasons(result), ElementsAre());
  result.summary.dropped = 76;
  fusion::config::TrackerConfig tracker;
  tracker.history_scans = 4;
  EXPECT_THAT(reasons(result, tracker),
              ElementsAre("76 of 150 lists were dropped as too old: a list is taken in up to 4 "
                          "lists back (history_scans)"));
}

TEST(RecordingReasons, WithoutATrackItSaysWhatOneNeeds) {
  StrategyResult result = sound();
  result.made_track = false;
  EXPECT_THAT(reasons(result),
              ElementsAre("no track came of 200 lists played within 10 s, 200 of them fused: a track needs 3 hits in 5 "
                          "lists (confirm_hits, confirm_window), and ends 1 s after its last observation "
                          "(delete_after)"));
  fusion::config::TrackerConfig tracker;
  tracker.birth = fusion::config::Birth::kExistence;
  EXPECT_THAT(reasons(result, tracker),
              ElementsAre(testing::HasSubstr("a track needs the probability 0.99 to exist (confirm_existence)")));
}

TEST(TrackWatch, SeesAConfirmedTrackOnce) {
  TrackWatch watch;
  recording::records::FusionStep step;
  watch.on(step);
  EXPECT_FALSE(watch.any());
  step.confirmed = 1;
  watch.on(step);
  step.confirmed = 0;
  watch.on(step);
  EXPECT_TRUE(watch.any());
}

}  // namespace
}  // namespace ttf::cli::drive
