#include "evaluation/accuracy/drive_measures.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "tests/evaluation/accuracy/synthetic_uses.h"

namespace ttf::evaluation::accuracy {
namespace {

GlobalTime global(std::int64_t ms) { return GlobalTime{} + Duration::milliseconds(ms); }

TEST(Measures, OfNothingThereIsNoError) {
  for (const bool with_image : {false, true}) {
    DriveMeasures measures(TrueTime{});
    if (with_image) {
      // A spurious object, 50 m from the only true one.
      write_image(measures, 0, global(40), {{60, 0}});
      use_image(measures, 0, at(40), {{60, 0}});
      truth_at(measures, at(40), 0, 10, 0);
    }
    const DriveSummary summary = measures.finish();
    EXPECT_EQ(summary.matched, 0u);
    EXPECT_EQ(summary.missed, with_image ? 1u : 0u);
    EXPECT_EQ(summary.spurious, with_image ? 1u : 0u);
    for (const double value :
         {summary.position_rmse_truth, summary.velocity_rmse_truth, summary.position_rmse_reference,
          summary.velocity_rmse_reference, summary.nees, summary.nees_low, summary.nees_high, summary.rmse_truth[0],
          summary.rmse_truth[1], summary.rmse_truth[2], summary.rmse_truth[3]})
      EXPECT_TRUE(std::isnan(value)) << value;
    EXPECT_EQ(summary.age_used.count, 0u);
  }
}

TEST(Measures, ErrorsAreOfThePairsAtTheUse) {
  DriveMeasures measures(TrueTime{});
  write_image(measures, 0, global(40), {{10.3, 0.4}, {20, 1}});
  use_image(measures, 0, at(40), {{10.3, 0.4}, {20, 1}});
  truth_at(measures, at(40), 0, 20, 0);
  truth_at(measures, at(40), 1, 10, 0);
  // Another node has recorded the same truth at that instant.
  for (const int object : {0, 1}) {
    recording::records::TruthState again{at(40), static_cast<ObjectId>(object), object == 0 ? 20.0 : 10.0, 0};
    again.node = NodeId{3};
    measures.on(again);
  }
  // Truth of another instant is not for this use.
  truth_at(measures, at(41), 0, 50, 0);
  const DriveSummary summary = measures.finish();
  EXPECT_EQ(summary.matched, 2u);
  EXPECT_EQ(summary.missed, 0u);
  EXPECT_NEAR(summary.rmse_truth[0], std::sqrt(0.09 / 2), 1e-12);
  EXPECT_NEAR(summary.rmse_truth[1], std::sqrt((0.16 + 1.0) / 2), 1e-12);
  EXPECT_NEAR(summary.position_rmse_truth, std::sqrt((0.25 + 1.0) / 2), 1e-12);
  EXPECT_EQ(summary.velocity_rmse_truth, 0.0);
  // Sigma is one in all four components, and only the position errs.
  EXPECT_EQ(summary.nees_samples, 2u);
  EXPECT_NEAR(summary.nees, (0.25 + 1.0) / 2, 1e-12);
}

// Two images predicted to the same instant: the used one is judged, by its own covariance.
TEST(Measures, ConsistencyIsOfTheImageThatWasUsed) {
  for (const std::uint32_t used : {7u, 8u}) {
    DriveMeasures measures(TrueTime{});
    write_image(measures, 7, global(40), {{11, 0, 1.0}});
    write_image(measures, 8, global(40), {{12, 0, 1.0}});
    use_image(measures, used, at(40), {{used == 7 ? 11.0 : 12.0, 0}});
    truth_at(measures, at(40), 0, 10, 0);
    const DriveSummary summary = measures.finish();
    EXPECT_EQ(summary.nees_samples, 1u);
    EXPECT_NEAR(summary.nees, used == 7 ? 1.0 : 4.0, 1e-12);
  }
}

// The image's time stamp is rounded on the bus: the sequence number identifies it.
TEST(Measures, ConsistencyDoesNotHangOnTheTimeStampsRounding) {
  DriveMeasures measures(TrueTime{});
  write_image(measures, 3, GlobalTime{40'000'123}, {{11, 0, 1.0}});
  use_image(measures, 3, at(40), {{11, 0}});
  truth_at(measures, at(40), 0, 10, 0);
  EXPECT_EQ(measures.finish().nees_samples, 1u);
}

// Two estimates of one object: one of them is spurious, for the errors and for the consistency.
TEST(Measures, ConsistencyUsesThePairsOfTheErrors) {
  DriveMeasures measures(TrueTime{});
  const std::vector<Shown> shown{{13, 0, 1.0}, {10.5, 0, 1.0}};
  write_image(measures, 0, global(40), shown);
  use_image(measures, 0, at(40), shown);
  truth_at(measures, at(40), 0, 10, 0);
  const DriveSummary summary = measures.finish();
  EXPECT_EQ(summary.matched, 1u);
  EXPECT_EQ(summary.spurious, 1u);
  EXPECT_EQ(summary.nees_samples, 1u);
  EXPECT_NEAR(summary.nees, 0.25, 1e-12);
  EXPECT_NEAR(summary.position_rmse_truth, 0.5, 1e-12);
}

// A second use of an image counts for the errors. It is no sample of the prediction for the first use.
TEST(Measures, ARepeatedUseIsNoSampleOfConsistency) {
  DriveMeasures measures(TrueTime{});
  write_image(measures, 0, global(40), {{11, 0, 1.0}});
  use_image(measures, 0, at(40), {{11, 0}});
  truth_at(measures, at(40), 0, 10, 0);
  use_image(measures, 0, at(80), {{11, 0}}, false);
  truth_at(measures, at(80), 0, 8, 0);
  const DriveSummary summary = measures.finish();
  EXPECT_EQ(summary.matched, 2u);
  EXPECT_NEAR(summary.position_rmse_truth, std::sqrt((1.0 + 9.0) / 2), 1e-12);
  EXPECT_EQ(summary.nees_samples, 1u);
  EXPECT_NEAR(summary.nees, 1.0, 1e-12);
}

TEST(Measures, AnImageNobodyUsedIsNotJudged) {
  DriveMeasures measures(TrueTime{});
  write_image(measures, 0, global(40), {{90, 0, 1.0}});
  write_image(measures, 1, global(80), {{11, 0, 1.0}});
  use_image(measures, 1, at(80), {{11, 0}});
  truth_at(measures, at(80), 0, 10, 0);
  const DriveSummary summary = measures.finish();
  EXPECT_EQ(summary.nees_samples, 1u);
  EXPECT_NEAR(summary.nees, 1.0, 1e-12);
}

TEST(Measures, NothingBeforeTheStartIsJudged) {
  DriveMeasures measures(at(100));
  for (const std::int64_t ms : {60, 120}) {
    write_image(measures, static_cast<std::uint32_t>(ms), global(ms), {{11, 0}});
    use_image(measures, static_cast<std::uint32_t>(ms), at(ms), {{11, 0}});
    truth_at(measures, at(ms), 0, 10, 0);
  }
  const DriveSummary summary = measures.finish();
  EXPECT_EQ(summary.uses, 1u);
  EXPECT_EQ(summary.matched, 1u);
}

void fuse(recording::records::Sink& sink, std::uint8_t sensor, std::uint32_t sequence, std::int64_t measured_ms) {
  recording::records::ListFused fused;
  fused.id = {SensorId{sensor}, sequence};
  fused.measured = global(measured_ms);
  fused.stamp.true_time = at(measured_ms + 30);
  fused.stamp.global = global(measured_ms + 30);
  sink.on(fused);
}

// Each quantity by its own sigma: errors of 0.2 rad across the half turn, 1 m/s, 0.6 m and 0.1 m, sigmas 0.1, 2, 0.3, 0.2.
// The acceleration's sigma is 0: the model has none. Position and velocity err by 1 m and 2 m/s, with variances of 4.
TEST(Measures, ConsistencyOfEachQuantity) {
  DriveMeasures measures(TrueTime{});
  const std::array<double, 6> state{11, 0, 2, 0, 0, 0};
  std::array<double, 36> covariance{};
  for (std::size_t k = 0; k < 6; ++k) covariance[7 * k] = 4.0;
  recording::records::TrackState track{{}, 1, TrackId{0}, global(40), state, covariance, true, {}};
  track.box = {{-3.0, 0.1}, {5.0, 2.0}, {9.0, 0.0}, {4.0, 0.3}, {1.9, 0.2}};
  recording::records::ImageWritten image;
  const std::array<recording::records::ImageObject, 1> objects{{{TrackId{0}, 11, 0}}};
  image.objects = objects;
  const auto judge = [&](DriveMeasures& by) {
    by.on(track);
    by.on(image);
    use_image(by, 0, at(40), {{11, 0}});
    recording::records::TruthState truth;
    truth.at = at(40);
    truth.x = 10;
    truth.heading = 2.0 * std::numbers::pi - 3.2;  // 3.083 rad
    truth.speed = 4.0;
    truth.acceleration = 1.0;
    truth.length = 4.6;
    truth.width = 1.8;
    by.on(truth);
  };
  judge(measures);
  const DriveSummary summary = measures.finish();
  const double vx = 2.0 - 4.0 * std::cos(3.2), vy = 4.0 * std::sin(3.2);
  EXPECT_NEAR(summary.own.position, 0.25 / 2.0, 1e-12);
  EXPECT_NEAR(summary.own.velocity, (vx * vx + vy * vy) / 4.0 / 2.0, 1e-12);
  EXPECT_NEAR(summary.own.heading, 4.0, 1e-9);
  EXPECT_NEAR(summary.own.speed, 0.25, 1e-12);
  EXPECT_TRUE(std::isnan(summary.own.acceleration));
  EXPECT_NEAR(summary.own.length, 4.0, 1e-9);
  EXPECT_NEAR(summary.own.width, 0.25, 1e-9);
  // An old log has the state only.
  track.box.reset();
  DriveMeasures old(TrueTime{});
  judge(old);
  const DriveSummary before = old.finish();
  EXPECT_EQ(before.nees, summary.nees);
  for (const double value : {before.own.heading, before.own.speed, before.own.length, before.own.width})
    EXPECT_TRUE(std::isnan(value));
}

// Innovations are summed over lists, from the begin of the judged part on.
TEST(Measures, InnovationsOverTheirDegrees) {
  DriveMeasures measures(at(100));
  EXPECT_TRUE(std::isnan(DriveMeasures(TrueTime{}).finish().own.innovations));
  const auto list = [&](std::int64_t ms, double squares, std::uint32_t degrees) {
    recording::records::ListFused fused;
    fused.stamp.true_time = at(ms);
    fused.innovation_squares = squares;
    fused.innovation_degrees = degrees;
    measures.on(fused);
  };
  list(60, 1000.0, 2);
  list(100, 3.0, 2);
  list(140, 0.0, 0);
  list(180, 9.0, 6);
  const DriveSummary summary = measures.finish();
  EXPECT_NEAR(summary.own.innovations, 12.0 / 8.0, 1e-12);
  EXPECT_EQ(summary.own.innovation_degrees, 8u);
}

// Two lists are held back, one over three fusion instants and one over one; a third is fused at once.
TEST(Measures, HaveTheTimeThatAListWasHeldBack) {
  DriveMeasures measures(TrueTime{});
  const auto becomes = [&](std::uint32_t sequence, recording::records::Disposition what, std::int64_t ms) {
    recording::records::ListFused list;
    list.id = {SensorId{0}, sequence};
    list.measured = global(10 * sequence);
    list.disposition = what;
    list.stamp.global = global(ms);
    measures.on(list);
  };
  using enum recording::records::Disposition;
  for (const std::int64_t ms : {50, 60, 70}) becomes(1, kHeld, ms);
  becomes(2, kHeld, 70);
  becomes(2, kDuplicate, 75);
  becomes(1, kFused, 80);
  becomes(2, kFusedLate, 80);
  becomes(3, kFused, 80);
  const DriveSummary summary = measures.finish();
  EXPECT_EQ(summary.held, 4u);
  EXPECT_EQ(summary.held_for.count, 2u);
  EXPECT_EQ(summary.held_for.mean(), Duration::milliseconds(20));
  EXPECT_EQ(summary.held_for.worst, Duration::milliseconds(30));
}

// Sensor 1 falls silent at 100 ms; its information is older at every use, for any length of silence.
TEST(Measures, TheAgeOfADeadSensorGrowsOn) {
  DriveMeasures measures(TrueTime{});
  fuse(measures, 1, 5, 100);
  for (std::uint32_t k = 0; k < 1'000; ++k) {
    const std::int64_t now = 140 + 40 * k;
    fuse(measures, 0, k, now - 40);
    write_image(measures, k, global(now), {}, {{SensorId{1}, 5}, {SensorId{0}, k}});
    use_image(measures, k, at(now), {});
  }
  const DriveSummary summary = measures.finish();
  EXPECT_EQ(summary.age_used.count, 2'000u);
  EXPECT_EQ(summary.age_used_by_sensor.at(SensorId{0}).worst, Duration::milliseconds(40));
  EXPECT_EQ(summary.age_used_by_sensor.at(SensorId{1}).worst, Duration::milliseconds(40 + 999 * 40));
}

// Sensor and fusion node restart and count anew: numbers refer to the later ones.
TEST(Measures, NumbersThatBeginAgainMeanTheLatest) {
  DriveMeasures measures(TrueTime{});
  for (std::uint32_t k = 0; k < 20; ++k) {
    fuse(measures, 0, k, 40 * k);
    write_image(measures, k, global(40 * k + 40), {{11, 0, 1.0}}, {{SensorId{0}, k}});
  }
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::int64_t now = 2'000 + 40 * k;
    fuse(measures, 0, k, now - 40);
    write_image(measures, k, global(now), {{11, 0, 1.0}}, {{SensorId{0}, k}});
    use_image(measures, k, at(now), {{11, 0}});
    truth_at(measures, at(now), 0, 10, 0);
  }
  const DriveSummary summary = measures.finish();
  EXPECT_EQ(summary.age_used.count, 3u);
  EXPECT_EQ(summary.age_used.worst, Duration::milliseconds(40));
  EXPECT_EQ(summary.nees_samples, 3u);
}

TEST(Measures, AnImageThatWasRefusedWasNotUsed) {
  DriveMeasures measures(TrueTime{});
  fuse(measures, 0, 0, 0);
  write_image(measures, 0, global(40), {{10, 0, 1.0}}, {{SensorId{0}, 0}});
  use_image(measures, 0, at(40), {{10, 0}});
  truth_at(measures, at(40), 0, 10, 0);
  recording::records::FeatureUsed refused;
  refused.stamp.true_time = at(400);
  refused.stamp.global = global(400);
  refused.image_valid_at = global(40);
  refused.fresh = false;
  refused.stale = true;
  measures.on(refused);
  truth_at(measures, at(400), 0, 10, 0);
  const DriveSummary summary = measures.finish();
  EXPECT_EQ(summary.uses, 2u);
  EXPECT_EQ(summary.stale_uses, 1u);
  EXPECT_EQ(summary.age_used.count, 1u);
  EXPECT_EQ(summary.matched, 1u);
  EXPECT_EQ(summary.missed, 1u) << "who has no image sees nothing";
}

// The first car is half a metre too long. The second image misses the other.
TEST(Measures, BoxesAreThoseOfPairsAndTrackingIsOfAll) {
  DriveMeasures measures(TrueTime{}, kGate_m, std::nullopt, {2.0, 1.0});
  for (const int use : {0, 1}) {
    std::vector<recording::records::FeatureObject> objects(use == 0 ? 2 : 1);
    objects[0].image = {TrackId{3}, 30.0, 0.0, 0.1, 9.0, 0.5, 5.0, 1.8};
    if (use == 0) objects[1].image = {TrackId{4}, 60.0, 1.0, 0.0, 10.0, 0.0, 4.5, 1.8};
    recording::records::FeatureUsed used;
    used.stamp = {at(40 + 40 * use), {}, global(40 + 40 * use), {}};
    used.objects = objects;
    measures.on(used);
    for (const std::uint16_t object : {0, 1}) {
      recording::records::TruthState truth{at(40 + 40 * use), ObjectId{object}, object == 0 ? 30.0 : 60.0};
      truth.speed = 10.0;
      truth.length = 4.5;
      truth.width = 1.8;
      measures.on(truth);
    }
  }
  const DriveSummary summary = measures.finish();
  EXPECT_EQ(summary.matched, 3u);
  EXPECT_EQ(summary.missed, 1u);
  const auto rms_of_two_in_three = [](double error) { return std::sqrt(2.0 * error * error / 3.0); };
  EXPECT_NEAR(summary.box.heading_rad, rms_of_two_in_three(0.1), 1e-12);
  EXPECT_NEAR(summary.box.speed_mps, rms_of_two_in_three(1.0), 1e-12);
  EXPECT_NEAR(summary.box.acceleration_mps2, rms_of_two_in_three(0.5), 1e-12);
  EXPECT_NEAR(summary.box.length_m, rms_of_two_in_three(0.5), 1e-12);
  EXPECT_EQ(summary.box.width_m, 0.0);
  // The rear is 2.5 m behind the image's centre, and 2.25 m behind the true one. The third pair is 1 m apart.
  const double dx = -2.5 * std::cos(0.1) + 2.25, dy = -2.5 * std::sin(0.1);
  EXPECT_NEAR(summary.box.face_m, std::sqrt((2.0 * (dx * dx + dy * dy) + 1.0) / 3.0), 1e-12);
  // The box begins where the line of sight meets the rear.
  const double ahead = (30.0 - 2.5 / std::cos(0.1)) - 27.75;
  const double beside = std::hypot(60.0, 1.0) * (1.0 - 2.25 / 60.0) - 57.75;
  EXPECT_NEAR(summary.box.gap_m, std::sqrt((2.0 * ahead * ahead + beside * beside) / 3.0), 1e-12);
  // c = 2, p = 1: 0 + 1 at the first use, 0 and a miss of c / 2 at the second.
  EXPECT_EQ(summary.tracking.cut_off.distance_m, 2.0);
  EXPECT_NEAR(summary.tracking.gospa.distance_m, 1.0, 1e-12);
  EXPECT_NEAR(summary.tracking.gospa.localisation, 0.5, 1e-12);
  EXPECT_NEAR(summary.tracking.gospa.missed, 0.5, 1e-12);
  EXPECT_NEAR(summary.tracking.mot.mota(), 0.75, 1e-12);
  EXPECT_NEAR(summary.tracking.lives.mean_fraction_tracked, 0.75, 1e-12);
}

}  // namespace
}  // namespace ttf::evaluation::accuracy
