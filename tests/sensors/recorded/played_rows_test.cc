// Rows are played at the instants at which they were measured, in one of three ways, or refused with numbers.
#include "sensors/recorded/played_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/errors.h"
#include "schedules/file/loader.h"
#include "tests/support/refusals.h"

namespace ttf::sensors::recorded {
namespace {

using recording::rows::RecordedInput;
using recording::rows::RecordedObservation;
using testing::HasSubstr;

constexpr Duration kEnd = Duration::milliseconds(1'000);

schedules::model::Cluster shipped(const char* name) {
  return schedules::file::load_cluster(std::string(TTF_SOURCE_DIR "/schedules/") + name + ".yaml");
}

// Laser rows at these stamps [us]; row i has x = i and line i + 1.
RecordedInput laser_at(const std::vector<std::int64_t>& stamps) {
  RecordedInput input;
  input.name = "m.txt";
  input.first_time_us = 5'000'000;
  for (const std::int64_t stamp : stamps) {
    RecordedObservation& row = input.observations.emplace_back();
    row.sensor = "laser";
    row.time_us_from_start = stamp;
    row.x = static_cast<double>(input.observations.size() - 1);
    row.line = static_cast<int>(input.observations.size());
  }
  return input;
}

std::vector<std::int64_t> every(std::int64_t gap, int count) {
  std::vector<std::int64_t> stamps;
  for (int i = 0; i < count; ++i) stamps.push_back(gap * i);
  return stamps;
}

PlayedRows played(const std::vector<std::int64_t>& stamps, const RecordedPlaying& playing = {},
                  const schedules::model::Cluster& cluster = shipped("laser_radar")) {
  return played_rows(laser_at(stamps), cluster, *cluster.find_sensor("laser"), playing, kEnd);
}

std::string refusal(const std::vector<std::int64_t>& stamps, const RecordedPlaying& playing = {},
                    const schedules::model::Cluster& cluster = shipped("laser_radar")) {
  return support::refusal_of([&] { (void)played(stamps, playing, cluster); });
}

TEST(PlayedRows, OfTheScheduleAreThoseInTheirOrder) {
  for (const char* cluster : {"laser_radar", "laser_radar_synchronised"}) {
    const PlayedRows all = played(every(100'000, 10), {}, shipped(cluster));
    ASSERT_EQ(all.at.size(), 11u) << "0 to 1 s";
    for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(all.at[i]->x, static_cast<double>(i));
    EXPECT_FALSE(all.at[10]) << "after the recording's end";
    EXPECT_EQ(all.lists, 10u);
    EXPECT_EQ(all.between + all.beyond + all.silent, 0u);
    EXPECT_EQ(all.times[3], Duration::milliseconds(300));
    EXPECT_EQ(all.instants.empty(), cluster == std::string("laser_radar_synchronised")) << "its host has it measure";
  }
}

TEST(PlayedRows, ALostRowDoesNotShiftTheOthers) {
  std::vector<std::int64_t> stamps = every(100'000, 10);
  stamps.erase(stamps.begin() + 4);
  const PlayedRows some = played(stamps);
  EXPECT_FALSE(some.at[4]);
  EXPECT_EQ(some.at[5]->time_us_from_start, 500'000);
  EXPECT_EQ(some.lists, 9u);
  EXPECT_EQ(some.silent, 1u);
}

TEST(PlayedRows, LeftoversAreCounted) {
  const PlayedRows dense = played(every(50'000, 30));  // every second instant, and 0.45 s too long
  EXPECT_EQ(dense.rows, 30u);
  EXPECT_EQ(dense.lists, 11u);
  EXPECT_EQ(dense.between, 10u);
  EXPECT_EQ(dense.beyond, 9u);
  EXPECT_EQ(dense.at[3]->time_us_from_start, 300'000);
}

TEST(PlayedRows, AStampOffTheScheduleIsRefusedWithItsInstants) {
  std::vector<std::int64_t> stamps = every(100'000, 10);
  stamps[6] += 900;
  EXPECT_EQ(refusal(stamps), "");
  stamps[6] += 200;
  const std::string sentence = refusal(stamps);
  EXPECT_THAT(sentence, HasSubstr("m.txt:7: t_us = 5601100: must be within 1 ms of an instant at which "));
  EXPECT_THAT(sentence, HasSubstr("has laser measure: every 100 ms, so at 5600000 us and 5700000 us; 1 of 10 rows of "
                                  "laser are not"));
  RecordedPlaying lenient;
  lenient.tolerance = Duration::milliseconds(2);
  EXPECT_EQ(refusal(stamps, lenient), "");
  EXPECT_THAT(refusal(every(105'000, 9)), HasSubstr("m.txt:2: t_us = 5105000: must be within 1 ms"));
}

TEST(PlayedRows, AFreeDeviceMayMeasureAtTheStamps) {
  const RecordedPlaying playing{RowsArePlayed::kAtTheirStamps, Duration::milliseconds(1)};
  const PlayedRows own = played(every(105'000, 12), playing);
  EXPECT_EQ(own.lists, 10u);
  EXPECT_EQ(own.beyond, 2u);
  ASSERT_EQ(own.instants.size(), 10u);
  EXPECT_EQ(own.instants[3], Duration::milliseconds(315));
  EXPECT_EQ(own.times, own.instants) << "its clock is exact and its phase zero";
  EXPECT_THAT(refusal({0, 100'000, 190'000}, playing),
              HasSubstr("m.txt:3: t_us = 5190000: must be 100 ms or more after the row before of laser, 5100000 us"));
  EXPECT_THAT(refusal(every(105'000, 9), playing, shipped("laser_radar_synchronised")),
              HasSubstr("plays them otherwise: resampled)"))
      << "the schedule triggers this device";
}

TEST(PlayedRows, AFreeDeviceNeedsAKnownClockAndPhase) {
  schedules::model::Cluster cluster = shipped("laser_radar");
  cluster.nodes[index_of(cluster.sensors[0].device)].drift_ppb.reset();
  EXPECT_THAT(refusal(every(100'000, 9), {}, cluster), HasSubstr("nodes.laser.drift_ppm: must be given"));
  cluster = shipped("laser_radar");
  cluster.sensors[0].phase.reset();
  EXPECT_THAT(refusal(every(100'000, 9), {}, cluster), HasSubstr("sensors.laser.phase: must be given"));
  EXPECT_EQ(refusal(every(105'000, 9), {RowsArePlayed::kAtTheirStamps, {}}, cluster), "");
  cluster = shipped("laser_radar");
  cluster.nodes[index_of(cluster.sensors[0].device)].drift_ppb = 1'000'000;  // 0.9 ms early after 0.9 s
  EXPECT_EQ(refusal(every(100'000, 10), {}, cluster), "");
  EXPECT_THAT(refusal(every(100'000, 10), {RowsArePlayed::kAsScheduled, Duration::microseconds(500)}, cluster),
              HasSubstr("m.txt:7: t_us = 5600000"));
}

TEST(PlayedRows, ResampledListsLieBetweenTheirRows) {
  const RecordedPlaying playing{RowsArePlayed::kResampled, Duration::milliseconds(1)};
  const PlayedRows between = played(every(80'000, 20), playing);
  EXPECT_EQ(between.lists, 11u);
  EXPECT_DOUBLE_EQ(between.at[0]->x, 0.0);
  EXPECT_DOUBLE_EQ(between.at[1]->x, 1.25);
  EXPECT_DOUBLE_EQ(between.at[4]->x, 5.0) << "a row of its own";
  EXPECT_EQ(between.at[1]->time_us_from_start, 100'000);
  EXPECT_EQ(between.beyond, 6u) << "1040 ms, used for the last list at 1000 ms, is not among them";
  const PlayedRows gap = played({0, 80'000, 290'000, 370'000}, playing);
  EXPECT_FALSE(gap.at[1]);
  EXPECT_FALSE(gap.at[2]);
  EXPECT_TRUE(gap.at[3]);
  EXPECT_EQ(gap.silent, 2u);
}

TEST(PlayedRows, BearingsAreResampledTheShorterWayRound) {
  const schedules::model::Cluster cluster = shipped("laser_radar");
  RecordedInput input;
  for (const double bearing : {3.1, -3.1}) {
    RecordedObservation& row = input.observations.emplace_back();
    row.sensor = "radar";
    row.kind = RecordedObservation::Kind::kRangeBearingRate;
    row.bearing = bearing;
    row.time_us_from_start = bearing > 0 ? 0 : 100'000;
  }
  const PlayedRows rows = played_rows(input, cluster, *cluster.find_sensor("radar"),
                                      {RowsArePlayed::kResampled, Duration::milliseconds(1)}, kEnd);
  ASSERT_TRUE(rows.at[0]) << "at 50 ms";
  EXPECT_NEAR(rows.at[0]->bearing, std::numbers::pi, 1e-12);
}

}  // namespace
}  // namespace ttf::sensors::recorded
