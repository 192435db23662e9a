// Drives by hand: a vehicle and one ahead, and the warnings of a service.
#include "evaluation/driving/driving_account.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ttf::evaluation::driving {
namespace {

using namespace recording::records;

constexpr TrueTime at_ms(std::int64_t ms) { return TrueTime{} + Duration::milliseconds(ms); }

struct Drive {
  DrivingAccount account{{.time_gap_s = 1.0, .standstill_m = 2.0}, TrueTime{}};

  // The vehicle at `x` with its speed and acceleration, and an object whose rear is `gap` ahead of its front.
  void at(std::int64_t ms, double x, double speed, double acceleration, double gap, double speed_ahead,
          double braking_ahead = 0.0, double y = 0.0) {
    EgoTruth ego;
    ego.at = at_ms(ms);
    ego.x = x;
    ego.vx = speed;
    ego.acceleration = acceleration;
    account.on(ego);
    TruthState object;
    object.at = at_ms(ms);
    object.length = 4.0;
    object.width = 1.8;
    object.x = gap + 3.4 + 2.0;
    object.y = y;
    object.speed = speed_ahead;
    object.acceleration = -braking_ahead;
    account.on(object);
  }
  void warn(std::int64_t ms, bool on) {
    Warning warning;
    warning.stamp.true_time = at_ms(ms);
    warning.service = kForwardCollision;
    warning.on = on;
    account.on(warning);
  }
  void command(std::int64_t ms) {
    CommandIssued command;
    command.stamp.true_time = at_ms(ms);
    account.on(command);
  }
};

TEST(DrivingAccount, TheSmallestGapAndTimeToCollisionAreOfTheObjectInTheWay) {
  Drive drive;
  drive.at(0, 0, 20, 0, 40, 20);
  drive.at(100, 2, 20, 0, 30, 10);
  drive.at(200, 4, 20, 0, 5, 10, 0.0, 2.5);  // in the next lane
  const DrivingFindings found = drive.account.finish();
  EXPECT_EQ(found.moments, 3u);
  EXPECT_NEAR(found.smallest_gap_m, 30.0, 1e-12);
  EXPECT_NEAR(found.smallest_ttc_s, 3.0, 1e-12);
  EXPECT_FALSE(found.collision);
  EXPECT_NEAR(found.gap_error_rms_m, std::sqrt((18.0 * 18.0 + 8.0 * 8.0) / 2), 1e-12);
}

TEST(DrivingAccount, IsJudgedUpToTheFirstCollision) {
  Drive drive;
  drive.at(0, 0, 20, 0, 1, 10);
  drive.at(100, 2, 20, -9, -0.1, 10);
  drive.at(200, 4, 20, -50, -1, 10);
  const DrivingFindings found = drive.account.finish();
  ASSERT_TRUE(found.collision);
  EXPECT_EQ(found.collision->at, at_ms(100));
  EXPECT_NEAR(found.collision->closing_mps, 10.0, 1e-12);
  EXPECT_EQ(found.smallest_gap_m, 0.0);
  EXPECT_EQ(found.largest_deceleration, 9.0);
  EXPECT_NEAR(found.largest_jerk, 90.0, 1e-9);
}

TEST(DrivingAccount, TheStoppingDistanceCountsFromTheBrakesAhead) {
  Drive drive;
  drive.at(0, 0, 10, 0, 30, 10);
  drive.at(1000, 10, 10, 0, 30, 10, 6.0);
  drive.at(2000, 20, 10, -10, 25, 4, 6.0);
  drive.at(3000, 25, 0, 0, 22, 0);
  const DrivingFindings found = drive.account.finish();
  ASSERT_TRUE(found.stopping_distance_m);
  EXPECT_NEAR(*found.stopping_distance_m, 15.0, 1e-12);
}

TEST(DrivingAccount, WarningsAreRightWrongMissedOrLate) {
  const auto hazard = [](Drive& drive, std::int64_t from, std::int64_t to) {
    for (std::int64_t ms = from - 1000; ms < from; ms += 20) drive.at(ms, 0, 10, 0, 100, 0);
    for (std::int64_t ms = from; ms <= to; ms += 20) drive.at(ms, 0, 10, 0, 20, 0);
    drive.at(to + 20, 0, 10, 0, 100, 0);
  };
  Drive drive;
  hazard(drive, 2000, 2600);
  hazard(drive, 6000, 6600);
  hazard(drive, 10'000, 10'600);
  drive.warn(2160, true);  // late by 160 ms
  drive.warn(2600, false);
  drive.warn(4000, true);  // wrong
  drive.warn(4500, false);
  drive.warn(9800, true);  // early, and right; it goes on
  for (std::int64_t ms = 9820; ms <= 10'600; ms += 40) drive.command(ms);
  const WarningFindings found = drive.account.finish().warnings[kForwardCollision];
  EXPECT_EQ(found.hazards, 3u);
  EXPECT_EQ(found.given, 3u);
  EXPECT_EQ(found.right, 2u);
  EXPECT_EQ(found.wrong, 1u);
  EXPECT_EQ(found.missed, 1u);
  EXPECT_EQ(found.late, 1u);
  EXPECT_EQ(found.latest, Duration::milliseconds(160));
}

TEST(DrivingAccount, ADeadServiceWarnsNoLonger) {
  for (const bool dies : {false, true}) {
    Drive drive;
    for (const std::int64_t hazard : {1000, 5000}) {
      for (std::int64_t ms = hazard; ms <= hazard + 600; ms += 20) drive.at(ms, 0, 10, 0, 20, 0);
      drive.at(hazard + 620, 0, 10, 0, 100, 0);
    }
    drive.warn(1000, true);
    for (std::int64_t ms = 1040; ms <= (dies ? 1400 : 5600); ms += 40) drive.command(ms);
    const WarningFindings found = drive.account.finish().warnings[kForwardCollision];
    EXPECT_EQ(found.right, 1u);
    EXPECT_EQ(found.missed, dies ? 1u : 0u);
  }
}

// On a bend the object ahead is off the x axis, and the one straight ahead is in another lane.
TEST(DrivingAccount, TheWayBends) {
  DrivingAccount account({}, TrueTime{});
  EgoTruth ego;
  ego.vx = 20.0;
  ego.yaw_rate = 0.05;  // a circle of 400 m
  account.on(ego);
  TruthState object;
  object.length = 4.0;
  object.width = 1.8;
  object.x = 40.0;
  object.y = 2.0;
  object.heading = 0.1;
  account.on(object);
  object.x = 30.0;
  object.y = -1.8;
  account.on(object);
  EXPECT_NEAR(account.finish().smallest_gap_m, 40.0 - 2.0 - 3.4, 1e-9);
}

TEST(DrivingAccount, ThePlaceInTheLaneIsThatOfTheFrontAxle) {
  const LaneConfig lane{{.pieces = {{.length = 500.0}}, .left = 0, .right = 2}, -2, 2.5, 1.8};
  DrivingAccount account({.lane = lane}, TrueTime{});
  std::int64_t ms = 0;
  for (const double y : {-5.25, -4.75, -3.85}) {  // the second lane's middle, and further left
    EgoTruth ego;
    ego.at = at_ms(ms += 100);
    ego.x = 50.0;
    ego.y = y - 2.5 * std::sin(0.02);
    ego.heading = 0.02;
    account.on(ego);
  }
  const DrivingFindings found = account.finish();
  ASSERT_TRUE(found.lane);
  EXPECT_NEAR(found.lane->largest_offset_m, 1.4, 1e-9);
  EXPECT_NEAR(found.lane->offset_rms_m, std::sqrt((0.25 + 1.96) / 3.0), 1e-9);
  EXPECT_NEAR(found.lane->heading_rms_rad, 0.02, 1e-9);
  EXPECT_NEAR(found.lane->outside, 1.0 / 3.0, 1e-9) << "from 0.85 m on a side is beyond its mark";
}

TEST(DrivingAccount, AnObjectBesideTheVehicleIsAHazardOfThatSide) {
  DrivingAccount account({.blind_spot = BlindSpotZone{}}, TrueTime{});
  const auto car_at = [&](std::int64_t ms, double x, double y) {
    EgoTruth ego;
    ego.at = at_ms(ms);
    account.on(ego);
    TruthState object;
    object.at = at_ms(ms);
    object.length = 4.4;
    object.width = 1.8;
    object.x = x;
    object.y = y;
    account.on(object);
  };
  for (std::int64_t ms = 0; ms < 1000; ms += 20) car_at(ms, -8.0, 3.5);     // too far behind
  for (std::int64_t ms = 1000; ms < 2000; ms += 20) car_at(ms, -2.0, 3.5);  // beside
  for (std::int64_t ms = 2000; ms < 3000; ms += 20) car_at(ms, -2.0, 7.0);  // two lanes away
  for (std::int64_t ms = 3000; ms < 4000; ms += 20) car_at(ms, 0.0, -3.5);
  Warning warning;
  warning.stamp.true_time = at_ms(1200);
  warning.service = kBlindSpotLeft;
  warning.on = true;
  account.on(warning);
  TaskRun run;  // the service's node lives
  for (std::int64_t ms = 1200; ms < 2000; ms += 40) {
    run.start.true_time = at_ms(ms);
    account.on(run);
  }
  warning.stamp.true_time = at_ms(2000);
  warning.on = false;
  account.on(warning);
  const DrivingFindings found = account.finish();
  EXPECT_TRUE(found.watches_blind_spot);
  EXPECT_EQ(found.warnings[kBlindSpotLeft].hazards, 1u);
  EXPECT_EQ(found.warnings[kBlindSpotLeft].right, 1u);
  EXPECT_EQ(found.warnings[kBlindSpotLeft].latest, Duration::milliseconds(200));
  EXPECT_EQ(found.warnings[kBlindSpotRight].missed, 1u);
  EXPECT_EQ(together(found.warnings[kBlindSpotLeft], found.warnings[kBlindSpotRight]).hazards, 2u);
}

}  // namespace
}  // namespace ttf::evaluation::driving
