#include "evaluation/accuracy/drive_measures.h"

#include <gtest/gtest.h>

#include <cmath>

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

// Two lists are held back, one over three fusion instants and one over one; a third is fused at once.
TEST(Measures, HowLongAListWasHeldBack) {
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

}  // namespace
}  // namespace ttf::evaluation::accuracy
