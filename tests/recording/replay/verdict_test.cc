// A replay that made nothing of its input, or dropped most of it, says why.
#include "recording/replay/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recording/replay/sensor_timing.h"
#include "tests/recording/replay/replay_rows.h"

namespace ttf::recording::replay {
namespace {

using fusion::strategies::StrategyKind;
using recording::rows::ObservationRow;
using testing::ElementsAre;

ReplayVerdict verdict_of(const std::vector<ObservationRow>& rows, ReplayConfig config = {}, std::uint64_t damaged = 0) {
  const RecordedLists lists = recorded_lists_of_rows(rows, config);
  const ReplaySetup setup{StrategyKind::kAdva, config.tracker, sensor_timings(lists, config, StrategyKind::kAdva),
                          false};
  const ReplayAccount account = replay(lists, setup, [](GlobalTime, std::span<const fusion::tracks::TrackView>) {});
  return judge(rows, {rows.size(), damaged}, lists, setup, account);
}

// A car that stands at (20, 3), seen once in `period_ms`.
std::vector<ObservationRow> standing(int lists, std::int64_t period_ms) {
  std::vector<ObservationRow> rows;
  for (int i = 0; i < lists; ++i) rows.push_back(position_row("camera", i * period_ms, i * period_ms, 20.0, 3.0));
  return rows;
}

TEST(ReplayVerdict, ASoundReplayHasDoneItsWork) {
  const ReplayVerdict verdict = verdict_of(two_cars(5));
  EXPECT_TRUE(verdict.did_its_work());
  EXPECT_THAT(verdict.reasons, ElementsAre());
}

TEST(ReplayVerdict, GapsAreNamedByTheKeyThatEndsTracks) {
  const ReplayVerdict longer = verdict_of(standing(41, 1'100));
  EXPECT_TRUE(longer.made_nothing);
  EXPECT_EQ(longer.headline, "no track came of 41 lists");
  EXPECT_THAT(longer.reasons,
              ElementsAre("40 of 40 gaps between successive lists are longer than 1 s, after which a track without "
                          "observation ends (delete_after); the middle gap is 1.1 s"));
  const ReplayVerdict equal = verdict_of(standing(41, 1'000));
  EXPECT_TRUE(equal.made_nothing);
  EXPECT_THAT(equal.reasons,
              ElementsAre("the middle gap between successive lists is 1 s: after it the position of a new track is "
                          "uncertain by 8 m (initial_velocity_sigma 8 m/s), and a track ends above 5 m "
                          "(delete_position_sigma)"));
  ReplayConfig patient;
  patient.tracker.delete_after = Duration::milliseconds(5'000);
  patient.tracker.delete_position_sigma = 50.0;
  EXPECT_TRUE(verdict_of(standing(41, 1'100), patient).did_its_work()) << "the keys that were named mend it";
}

TEST(ReplayVerdict, FewListsAndDuplicatesAreNamed) {
  EXPECT_THAT(verdict_of(standing(1, 100)).reasons,
              ElementsAre("1 list was used, and a track is confirmed by 3 hits (confirm_hits)"));
  std::vector<ObservationRow> again;
  for (int i = 0; i < 10; ++i) again.push_back(position_row("camera", 0, 10 * i, 20.0, 3.0));
  EXPECT_THAT(verdict_of(again).reasons,
              ElementsAre("1 list was used, and a track is confirmed by 3 hits (confirm_hits)",
                          "9 of 10 lists were heard before: they have the sensor and the time of another list"));
}

TEST(ReplayVerdict, DegreesAreSuspected) {
  std::vector<ObservationRow> rows;
  for (int i = 0; i < 30; ++i) {
    ObservationRow row = position_row("radar", 100 * i, 100 * i, 0.0, 0.0);
    row.kind = ObservationRow::Kind::kRangeBearing;
    row.z = {30.0, 40.0 + i, 0.0};  // a degree in each list: 57 degrees to the reader
    rows.push_back(row);
  }
  const ReplayVerdict verdict = verdict_of(rows);
  EXPECT_TRUE(verdict.made_nothing);
  EXPECT_THAT(verdict.reasons,
              ElementsAre("30 of 30 bearings are beyond a whole turn of 6.283 rad: they may be in degrees"));
}

// An observation here, the next far away: nothing else is wrong.
TEST(ReplayVerdict, ElseTheHitsAreNamed) {
  std::vector<ObservationRow> rows;
  for (int i = 0; i < 20; ++i) rows.push_back(position_row("camera", 100 * i, 100 * i, 200.0 * i, 3.0));
  EXPECT_THAT(verdict_of(rows).reasons,
              ElementsAre("20 observations in 20 used lists never hit one object 3 times in 5 lists (confirm_hits, "
                          "confirm_window)"));
}

TEST(ReplayVerdict, TheCauseThatDropsMostOfTheInputIsNamed) {
  ReplayConfig config;
  config.tracker.history_scans = 8;
  std::vector<ObservationRow> rows = standing(30, 100);
  for (int i = 0; i < 60; ++i) {  // another sensor's lists, all of which come when the first sensor has ended
    ObservationRow row = position_row("slow", 10 + 30 * i, 4'000, 20.0, 3.0);
    rows.push_back(row);
  }
  const ReplayVerdict verdict = verdict_of(rows, config);
  EXPECT_FALSE(verdict.made_nothing);
  EXPECT_TRUE(verdict.dropped_most);
  EXPECT_EQ(verdict.headline, "most of the input was dropped");
  ASSERT_EQ(verdict.reasons.size(), 1u);
  EXPECT_THAT(verdict.reasons[0], testing::HasSubstr("of 90 lists were dropped as too old: a list is taken in up to 8 "
                                                     "lists back (history_scans), and the longest delay is 3.99 s"));
  const ReplayVerdict damaged = verdict_of(standing(30, 100), {}, 31);
  EXPECT_THAT(damaged.reasons, ElementsAre("31 of 61 rows were damaged and left out"));
  EXPECT_TRUE(verdict_of(standing(30, 100), {}, 30).did_its_work()) << "half is not most";
}

}  // namespace
}  // namespace ttf::recording::replay
