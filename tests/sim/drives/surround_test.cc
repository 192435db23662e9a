// Six sensors round a car that drives and turns, and objects that go round all of them.
#include <gtest/gtest.h>

#include <string>

#include "tests/sim/drives/coverage.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;

constexpr ObjectId kRound{0};

class Surround : public testing::TestWithParam<StrategyKind> {};
class SurroundSeeds : public testing::TestWithParam<StrategyKind> {};

// A car comes round the square against the vehicle, and round the vehicle within 10 s: ahead the laser, the camera with one lens
// and the long-range radar see it, aside a corner radar alone, behind the stereo camera, too.
TEST_P(Surround, ACarThatGoesRoundKeepsItsName) {
  const Drive drive("scenarios/surround.yaml", GetParam());
  Coverage coverage(sim::engine::kFirstCycle + Duration::milliseconds(1500));
  const DriveOutcome outcome = drive.run(coverage, 1, false);
  coverage.finish();
  ASSERT_EQ(coverage.objects.size(), 25u);
  const Coverage::Object& round = coverage.objects.at(kRound);
  EXPECT_GT(round.uses, 500);
  EXPECT_GE(round.shown, 0.97 * round.uses);
  EXPECT_EQ(round.first, round.last);
  EXPECT_LE(round.tracks.size(), 4u);
  for (const auto& [id, object] : coverage.objects)
    EXPECT_GE(object.shown, 0.9 * object.uses) << "object " << index_of(id);
  EXPECT_EQ(outcome.counts.slot_problems, 0u);
  EXPECT_EQ(outcome.counts.deadlines_missed, 0u);
  EXPECT_EQ(outcome.counts.torn_lists, 0u);
  EXPECT_EQ(outcome.counts.overwritten_lists, 0u);
}

// Parked cars go round the vehicle, too, as it turns. Those that are seen for the first time at the edges of
// fields change their names now and then.
TEST_P(SurroundSeeds, MostObjectsKeepTheirNames) {
  const Drive drive("scenarios/surround.yaml", GetParam());
  constexpr std::uint64_t kDrives = 20;
  int round = 0, all = 0;
  double nees = 0.0, nis = 0.0;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    Coverage coverage(evaluation_start(drive.scenario));
    evaluation::accuracy::DriveMeasures measures(evaluation_start(drive.scenario));
    recording::records::Tee both({&coverage, &measures});
    drive.run(both, seed, false);
    coverage.finish();
    for (const auto& [id, object] : coverage.objects) {
      const bool kept = object.shown > 0 && object.first == object.last;
      all += kept;
      if (id == kRound) round += kept;
    }
    const evaluation::accuracy::DriveSummary summary = measures.finish();
    nees += summary.nees / kDrives;
    nis += summary.own.innovations / kDrives;
  }
  RecordProperty("round", round);
  RecordProperty("all", all);
  EXPECT_GE(round, 19) << "of " << kDrives;
  EXPECT_GE(all, 480) << "of 500";
  EXPECT_GT(nees, 2.5);
  EXPECT_LT(nees, 4.0);
  EXPECT_GT(nis, 0.65);  // too careful: docs/results/consistency_surround.md
  EXPECT_LT(nis, 1.0);
}

// The camera with one lens alone sees a car that stands 30 m ahead. Its pitch is the same in all pictures of a drive.
TEST(MonoCameraDrive, AConsideredPitchIsConsistentAnIgnoredOneIsNot) {
  constexpr double kPitch = 0.002;
  constexpr std::uint64_t kDrives = 20;
  Drive drive("scenarios/surround.yaml", StrategyKind::kTt);
  drive.scenario.duration = Duration::milliseconds(3000);
  drive.scenario.evaluate_from = Duration::milliseconds(2000);
  sim::world::WorldConfig& world = drive.scenario.world;
  world.ego.reset();
  world.objects.resize(1);
  sim::world::ObjectConfig& car = world.objects[0];
  car.x = 30.0, car.y = 0.0, car.heading = 0.0, car.speed = 0.0;
  car.segments.clear();
  sensors::kinds::Sensors& all = drive.scenario.sensors;
  all.of<sensors::odometry::Kind>().usual.model.yaw_rate_bias = {};
  all.of<sensors::laser::Kind>().usual.model.max_range_m = 1.0;
  for (auto& entry : all.of<sensors::stereo_camera::Kind>().own) entry.model.max_range_m = 1.0;
  for (auto& entry : all.of<sensors::radar::Kind>().own) entry.model.max_range_m = 1.0;
  auto& camera = all.of<sensors::mono_camera::Kind>().usual;
  camera.model.pitch.sigma = kPitch;
  camera.preprocessing->pitch_sigma_rad = 0.0;

  fusion::config::TrackerConfig& tracker = drive.scenario.tracker;
  tracker.motion = fusion::config::MotionModel::kConstantVelocity;
  tracker.process_noise = 0.1;
  // Half a length's error is the centre's, so the lengths are those of the prior.
  car.size.draw = sim::world::SizeDraw::kNormal;
  car.size.mean = {tracker.sizes.length, tracker.sizes.width};
  car.size.sigma = {tracker.sizes.length_sigma, tracker.sizes.width_sigma};
  car.size.correlation = tracker.sizes.correlation;
  car.size.normal = {2.0, 7.0, 1.0, 3.0};
  const double range = car.x - 0.5 * tracker.sizes.length - camera.model.device.placement.x;
  for (fusion::sensors::KnownSensor& known : tracker.sensors)
    if (known.name == "mono_camera") known.errors.sigma(0) = kPitch * range * range / camera.model.height_m;

  double nees[2] = {};
  for (const auto answer :
       {fusion::config::SystematicErrorsAre::kIgnored, fusion::config::SystematicErrorsAre::kConsidered}) {
    tracker.systematic = answer;
    for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
      evaluation::accuracy::DriveMeasures measures(evaluation_start(drive.scenario));
      drive.run(measures, seed, false);
      const evaluation::accuracy::DriveSummary summary = measures.finish();
      ASSERT_GT(summary.matched, 20u) << seed;
      nees[static_cast<std::size_t>(answer)] += summary.own.position / kDrives;
    }
  }
  EXPECT_GT(nees[1], 0.4);
  EXPECT_LT(nees[1], 1.7);
  EXPECT_GT(nees[0], 3.0 * nees[1]);
}

INSTANTIATE_TEST_SUITE_P(EveryStrategy, SurroundSeeds, testing::ValuesIn(fusion::strategies::kAllStrategies),
                         [](const auto& run) { return std::string(name_of(run.param)); });
INSTANTIATE_TEST_SUITE_P(EveryStrategy, Surround, testing::ValuesIn(fusion::strategies::kAllStrategies),
                         [](const auto& run) { return std::string(name_of(run.param)); });

}  // namespace
}  // namespace ttf::sim::drives
