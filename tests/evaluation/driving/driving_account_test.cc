// Drives by hand: a vehicle and one ahead, and the warnings of a service.
#include "evaluation/driving/driving_account.h"

#include <gtest/gtest.h>

#include <cmath>

#include "evaluation/accuracy/drive_measures.h"

namespace ttf::evaluation::driving {
namespace {

using namespace recording::records;

constexpr TrueTime at_ms(std::int64_t ms) { return TrueTime{} + Duration::milliseconds(ms); }

struct Drive {
  ObjectId ahead{};
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
    object.object = ahead;
    account.on(object);
  }
  void warn(std::int64_t ms, bool on) {
    Warning warning;
    warning.stamp.true_time = at_ms(ms);
    warning.service = WarningKind::kForwardCollision;
    warning.on = on;
    account.on(warning);
  }
  // An image with an object at this gap and speed, and a nearer one that is not confirmed.
  void image(std::int64_t ms, double gap, double speed) {
    ImageObject objects[2];
    objects[0].x = gap + 3.4 + 2.0;
    objects[0].length = 4.0;
    objects[0].width = 1.8;
    objects[0].speed = speed;
    objects[0].status = ImageStatus::kConfirmed;
    objects[1] = objects[0];
    objects[1].x -= 5.0;
    objects[1].speed = 0.0;
    objects[1].status = {};
    ImageWritten written;
    written.stamp.true_time = at_ms(ms);
    written.objects = objects;
    account.on(written);
  }
  void command(std::int64_t ms) {
    CommandIssued command;
    command.stamp.true_time = at_ms(ms);
    account.on(command);
  }
};

TEST(DrivingAccount, TheReactionTimeLastsFromTheTruthToTheImage) {
  Drive drive;
  drive.at(0, 0, 29, 0, 40, 29.0);
  drive.image(50, 40, 26.0);  // noise, before anything happens
  drive.at(100, 3, 29, 0, 40, 27.1, 8.0);
  drive.at(200, 6, 29, 0, 40, 26.9, 8.0);
  drive.image(250, 40, 28.0);
  drive.at(300, 9, 29, 0, 40, 26.0, 8.0);
  drive.image(350, 40, 27.1);
  drive.at(400, 12, 29, 0, 40, 25.0, 8.0);
  drive.image(450, 40, 26.9);
  drive.image(550, 40, 20.0);
  const DrivingFindings found = drive.account.finish();
  ASSERT_TRUE(found.reaction);
  EXPECT_EQ(*found.reaction, Duration::milliseconds(250));
  Drive slow;
  slow.at(0, 0, 29, 0, 40, 26.0);
  slow.image(50, 40, 26.0);
  slow.at(100, 0, 29, 0, 40, 26.0);
  EXPECT_FALSE(slow.account.finish().reaction) << "it was never fast";
}

// The moment at 200 ms is judged when that at 300 ms comes; the image lies between them.
TEST(DrivingAccount, TheReactionMayComeBeforeTheNextMoment) {
  Drive drive;
  drive.at(100, 3, 29, 0, 40, 27.1, 8.0);
  drive.image(150, 40, 26.9);  // noise
  drive.at(200, 6, 29, 0, 40, 26.9, 8.0);
  drive.image(250, 40, 26.9);
  drive.at(300, 9, 29, 0, 40, 26.0, 8.0);
  drive.image(350, 40, 26.0);
  const DrivingFindings found = drive.account.finish();
  ASSERT_TRUE(found.reaction);
  EXPECT_EQ(*found.reaction, Duration::milliseconds(50));
}

// The object ahead may be beside the way for some milliseconds before.
TEST(DrivingAccount, ASlowObjectThatComesInFrontIsNoReaction) {
  for (const bool another : {false, true})
    for (const std::int64_t beside : {0, 500, 5000}) {
      Drive drive;
      drive.at(0, 0, 29, 0, 40, 29.0);
      if (beside > 0) drive.at(100, 3, 29, 0, 40, 29.0, 0.0, 10.0);
      if (another) drive.ahead = ObjectId{7};
      drive.at(beside + 200, 6, 29, 0, 40, 20.0);
      drive.at(beside + 300, 9, 29, 0, 40, 20.0);
      drive.image(beside + 350, 40, 20.0);
      EXPECT_EQ(drive.account.finish().reaction.has_value(), !another && beside < 1000) << beside;
    }
}

TEST(DrivingAccount, AnObjectMayFallBelowTheSpeedBesideTheWay) {
  Drive drive;
  drive.at(0, 0, 29, 0, 40, 29.0);
  drive.at(100, 3, 29, 0, 40, 26.9, 8.0, 10.0);
  drive.at(200, 6, 29, 0, 40, 26.0, 8.0);
  drive.image(250, 40, 26.0);
  const DrivingFindings found = drive.account.finish();
  ASSERT_TRUE(found.reaction);
  EXPECT_EQ(*found.reaction, Duration::milliseconds(150));
}

// Two nodes report the truth some nanoseconds apart, in either order.
TEST(DrivingAccount, TheOrderOfNodesMakesNoDifference) {
  const auto judged = [](bool swapped) {
    Drive drive;
    const auto report = [&](std::int64_t ms, std::int64_t ns) {
      EgoTruth ego;
      ego.at = at_ms(ms) + Duration::nanoseconds(ns);
      ego.vx = 20.0;
      drive.account.on(ego);
      TruthState object;
      object.at = ego.at;
      object.length = 4.0;
      object.width = 1.8;
      object.x = 20.0 - 1e-3 * static_cast<double>(9 * ms) - 1e-3 * static_cast<double>(ns);
      drive.account.on(object);
    };
    for (std::int64_t ms = 0; ms < 2000; ms += 10) {
      report(ms, swapped ? 7 : 0);
      report(ms, swapped ? 0 : 7);
    }
    return drive.account.finish();
  };
  const DrivingFindings a = judged(false), b = judged(true);
  ASSERT_TRUE(a.collision && b.collision);
  EXPECT_EQ(a.collision->at, b.collision->at);
  EXPECT_EQ(a.moments, b.moments);
  EXPECT_EQ(a.gap_error_rms_m, b.gap_error_rms_m);
  EXPECT_EQ(a.smallest_ttc_s, b.smallest_ttc_s);
}

TEST(DetectionAccount, TheIntervalIsThatOfTheCameraLookedAtMost) {
  DetectionAccount account(at_ms(100));
  const auto detect = [&](std::int64_t ms, SensorId sensor, bool secondary) {
    DetectionMade made;
    made.begin = at_ms(ms);
    made.id.sensor = sensor;
    made.secondary = secondary;
    account.on(made);
  };
  EXPECT_FALSE(account.finish());
  detect(50, SensorId{0}, false);
  for (const std::int64_t frame : {0, 150, 300, 460}) {
    SequencePlanned planned;
    planned.stamp.true_time = at_ms(frame);
    account.on(planned);
  }
  detect(150, SensorId{0}, false);
  detect(190, SensorId{1}, false);
  detect(230, SensorId{1}, true);
  detect(300, SensorId{1}, false);
  const auto found = account.finish();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->primary, 3u);
  EXPECT_EQ(found->secondary, 1u);
  EXPECT_EQ(found->camera, SensorId{1});
  EXPECT_NEAR(found->intervals.mean(), 0.055, 1e-12);
  EXPECT_NEAR(found->intervals.deviation(), std::sqrt(2.0) * 0.015, 1e-12);
  EXPECT_EQ(found->frames.count(), 2u);
  EXPECT_NEAR(found->frames.mean(), 0.155, 1e-12);
}

TEST(DetectionAccount, TooFewSamplesHaveNoMeanAndNoDeviation) {
  Spread spread;
  EXPECT_EQ(spread.mean(), DrivingFindings::kNone);
  EXPECT_EQ(spread.deviation(), DrivingFindings::kNone);
  spread.add(Duration::milliseconds(20));
  EXPECT_NEAR(spread.mean(), 0.02, 1e-12);
  EXPECT_EQ(spread.deviation(), DrivingFindings::kNone);
  spread.add(Duration::milliseconds(20));
  EXPECT_EQ(spread.deviation(), 0.0);
}

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

// The vehicle drives into the object ahead at 80 ms.
TEST(DrivingAccount, TheImagesAreJudgedUpToTheCollisionToo) {
  DrivingAccount driving({}, TrueTime{});
  accuracy::DriveMeasures measures(TrueTime{});
  measures.end_with([&] { return driving.collided_at(); });
  for (std::int64_t i = 0; i < 5; ++i) {
    FeatureUsed used;
    used.stamp.true_time = at_ms(40 * i);
    measures.on(used);
    EgoTruth ego;
    ego.at = at_ms(40 * i);
    ego.vx = 20.0;
    driving.on(ego);
    TruthState object;
    object.at = ego.at;
    object.length = 4.0;
    object.width = 1.8;
    object.x = 3.4 + 2.0 + 1.5 - 0.8 * static_cast<double>(i);  // gaps of 1.5, 0.7 and -0.1 m
    driving.on(object);
    measures.on(object);
  }
  EXPECT_EQ(driving.collided_at(), at_ms(80));
  EXPECT_EQ(driving.finish().moments, 3u);
  const accuracy::DriveSummary summary = measures.finish();
  EXPECT_EQ(summary.uses, 3u);
  EXPECT_EQ(summary.missed, 3u);
  EXPECT_EQ(summary.tracking.instants, 3u);
}

TEST(DrivingAccount, AStandstillHasNoJerk) {
  Drive drive;
  drive.at(0, 0, 1, -8, 30, 0);
  drive.at(100, 0.1, 0.2, -8, 30, 0);
  drive.at(200, 0.1, 0, 0, 30, 0);
  drive.at(300, 0.1, 0.1, 0.5, 30, 0);
  drive.at(400, 0.1, 0.2, 0.6, 30, 0);
  const DrivingFindings found = drive.account.finish();
  EXPECT_NEAR(found.largest_jerk, 1.0, 1e-9);
  EXPECT_NEAR(found.jerk_rms, std::sqrt(0.5), 1e-9);
}

TEST(DrivingAccount, EveryVerdictOfTheActuatorIsCounted) {
  Drive drive;
  for (const CommandVerdict verdict :
       {CommandVerdict::kApplied, CommandVerdict::kNoneNew, CommandVerdict::kInvalid, CommandVerdict::kLate,
        CommandVerdict::kLate, CommandVerdict::kNothingAsked, CommandVerdict::kWeaker}) {
    CommandTaken taken;
    taken.verdict = verdict;
    drive.account.on(taken);
  }
  const DrivingFindings found = drive.account.finish();
  EXPECT_EQ(found.applied, 1u);
  EXPECT_EQ(found.none_new, 1u);
  EXPECT_EQ(found.invalid, 1u);
  EXPECT_EQ(found.late, 2u);
  EXPECT_EQ(found.nothing_asked, 1u);
  EXPECT_EQ(found.weaker, 1u);
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
  const WarningFindings found = drive.account.finish().warnings[index_of(WarningKind::kForwardCollision)];
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
    const WarningFindings found = drive.account.finish().warnings[index_of(WarningKind::kForwardCollision)];
    EXPECT_EQ(found.right, 1u);
    EXPECT_EQ(found.missed, dies ? 1u : 0u);
  }
}

// The node is back before the silence counts. It has no memory of the warning, so it never takes it back.
TEST(DrivingAccount, ANodeThatLosesItsSupplyForgetsItsWarning) {
  Drive drive;
  for (const std::int64_t hazard : {1000, 5000}) {
    for (std::int64_t ms = hazard; ms <= hazard + 600; ms += 20) drive.at(ms, 0, 10, 0, 20, 0);
    drive.at(hazard + 620, 0, 10, 0, 100, 0);
  }
  drive.warn(1000, true);
  for (std::int64_t ms = 1040; ms <= 5600; ms += 40) {
    const bool is_off = ms > 1400 && ms < 1800;
    if (!is_off) drive.command(ms);
    if (ms != 1400) continue;
    PowerChanged power;
    power.stamp.true_time = at_ms(ms);
    power.stamp.node = NodeId{7};
    ASSERT_NE(power.stamp.node, Stamp{}.node) << "another node's supply matters to no warning";
    drive.account.on(power);
    power.stamp.node = Stamp{}.node;
    power.on = false;
    drive.account.on(power);
  }
  const WarningFindings found = drive.account.finish().warnings[index_of(WarningKind::kForwardCollision)];
  EXPECT_EQ(found.given, 1u);
  EXPECT_EQ(found.right, 1u);
  EXPECT_EQ(found.missed, 1u) << "nobody warned of the second hazard";
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
  warning.service = WarningKind::kBlindSpotLeft;
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
  EXPECT_EQ(found.warnings[index_of(WarningKind::kBlindSpotLeft)].hazards, 1u);
  EXPECT_EQ(found.warnings[index_of(WarningKind::kBlindSpotLeft)].right, 1u);
  EXPECT_EQ(found.warnings[index_of(WarningKind::kBlindSpotLeft)].latest, Duration::milliseconds(200));
  EXPECT_EQ(found.warnings[index_of(WarningKind::kBlindSpotRight)].missed, 1u);
  EXPECT_EQ(together(found.warnings[index_of(WarningKind::kBlindSpotLeft)],
                     found.warnings[index_of(WarningKind::kBlindSpotRight)])
                .hazards,
            2u);
}

// Readings are 40 ms of global time apart. One is 300 us late, so the next one is early by that; a refused one is no
// end of an interval.
TEST(DrivingAccount, TheJitterOfReadingsIsAgainstTheClustersTime) {
  Drive drive;
  for (std::int64_t k = 0; k < 10; ++k) {
    CommandTaken taken;
    taken.stamp.global = GlobalTime{} + Duration::milliseconds(40 * k);
    taken.stamp.true_time = at_ms(1000 + 40 * k) + Duration::microseconds(k == 3 ? 300 : k == 7 ? 5000 : 0);
    taken.verdict = k == 7 ? CommandVerdict::kLate : CommandVerdict::kApplied;
    drive.account.on(taken);
  }
  const BinnedDurations jitter = drive.account.finish().reading_jitter;
  EXPECT_EQ(jitter.count(), 7u);
  EXPECT_EQ(jitter.longest(), Duration::microseconds(300));
  EXPECT_EQ(jitter.count_from(lateness_bin(Duration::microseconds(250))), 2u);
}

// The node loses the cluster's time after 400 ms, reads once by its own, and is back two seconds later. Its clock goes 100 ppm
// slow: that would be 200 us.
TEST(DrivingAccount, ALossOfGlobalTimeIsNoJitter) {
  DrivingAccount account({.reads_every = Duration::milliseconds(40)}, TrueTime{});
  const auto read = [&](std::int64_t ms, std::int64_t global_ms) {
    CommandTaken taken;
    taken.stamp.true_time = at_ms(ms) + Duration::microseconds(ms / 10);
    taken.stamp.local = LocalTime{} + Duration::milliseconds(ms - 17);
    taken.stamp.global = GlobalTime{} + Duration::milliseconds(global_ms);
    taken.verdict = CommandVerdict::kNoneNew;
    account.on(taken);
  };
  for (std::int64_t ms = 0; ms <= 400; ms += 40) read(ms, ms);
  read(440, 440 - 17);
  for (std::int64_t ms = 2440; ms <= 2840; ms += 40) read(ms, ms);
  const BinnedDurations jitter = account.finish().reading_jitter;
  EXPECT_EQ(jitter.count(), 20u);
  EXPECT_LT(jitter.longest(), Duration::microseconds(5));
}

TEST(DrivingAccount, AReadingAfterALongGapIsNoJitter) {
  for (const std::int64_t periods : {3, 4}) {
    DrivingAccount account({.reads_every = Duration::milliseconds(40)}, TrueTime{});
    for (const std::int64_t k : {std::int64_t{0}, periods}) {
      CommandTaken taken;
      taken.stamp.true_time = at_ms(41 * k);
      taken.stamp.global = GlobalTime{} + Duration::milliseconds(40 * k);
      account.on(taken);
    }
    EXPECT_EQ(account.finish().reading_jitter.count(), periods == 3 ? 1u : 0u);
  }
}

}  // namespace
}  // namespace ttf::evaluation::driving
