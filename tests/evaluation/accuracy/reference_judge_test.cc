#include "evaluation/accuracy/reference_judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/time.h"
#include "experiments/results/statistics.h"
#include "sim/world/world.h"
#include "tests/evaluation/accuracy/synthetic_uses.h"

namespace ttf::evaluation::accuracy {
namespace {

recording::records::ReferenceFix fix(std::int64_t ms, double x, double vx) {
  recording::records::ReferenceFix fix;
  fix.measured_true = at(ms);
  fix.x = x;
  fix.vx = vx;
  return fix;
}

TEST(ReferenceJudge, ComparesWithTheFixesInterpolatedOnceBothAreKnown) {
  ReferenceJudge judge(8.0);
  judge.fix(fix(0, 10.0, 4.0));
  // At 25 ms the reference is at 10.5 m with 4.5 m/s.
  judge.use(at(25), std::vector<PlaneEstimate>{{40, 0, 0, 0}, {10.5, 0.3, 4.5, 0.4}});
  EXPECT_EQ(judge.compared(), 0u) << "the second fix is not there yet";
  EXPECT_TRUE(std::isnan(judge.position_rmse()));
  EXPECT_TRUE(std::isnan(judge.velocity_rmse()));
  judge.fix(fix(100, 12.0, 6.0));
  EXPECT_EQ(judge.compared(), 1u);
  EXPECT_NEAR(judge.position_rmse(), 0.3, 1e-12);
  EXPECT_NEAR(judge.velocity_rmse(), 0.4, 1e-12);
  // A use judged immediately, as its fixes are known: 0.4 m away now.
  judge.use(at(50), std::vector<PlaneEstimate>{{11.4, 0, 5.0, 0.0}});
  EXPECT_EQ(judge.compared(), 2u);
  EXPECT_NEAR(judge.position_rmse(), std::sqrt((0.09 + 0.16) / 2), 1e-12);
  EXPECT_NEAR(judge.velocity_rmse(), std::sqrt(0.16 / 2), 1e-12);
}

// The velocity is the receiver's own: fixes that jump away do not change it.
TEST(ReferenceJudge, TheVelocityIsNotTheFixesDifference) {
  ReferenceJudge judge(8.0);
  judge.fix(fix(0, 10.0, 5.0));
  judge.fix(fix(100, 15.0, 5.0));
  judge.use(at(50), std::vector<PlaneEstimate>{{12.5, 0, 5.0, 0.0}});
  EXPECT_EQ(judge.velocity_rmse(), 0.0);
}

TEST(ReferenceJudge, WithoutVelocityOnlyThePositionCounts) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  ReferenceJudge judge(8.0);
  judge.fix(fix(0, 10.0, kNone));
  judge.fix(fix(100, 10.0, kNone));
  judge.use(at(50), std::vector<PlaneEstimate>{{10.0, 0.5, 1.0, 1.0}});
  EXPECT_EQ(judge.compared(), 1u);
  EXPECT_NEAR(judge.position_rmse(), 0.5, 1e-12);
  EXPECT_TRUE(std::isnan(judge.velocity_rmse()));
}

TEST(ReferenceJudge, AnObjectBeyondTheGateIsAnother) {
  ReferenceJudge judge(2.0);
  judge.fix(fix(0, 10.0, 0.0));
  judge.fix(fix(100, 10.0, 0.0));
  judge.use(at(50), std::vector<PlaneEstimate>{{12.1, 0, 0, 0}});
  judge.use(at(60), {});
  EXPECT_EQ(judge.compared(), 0u);
}

// A use that lies outside the fixes is not extrapolated to.
TEST(ReferenceJudge, NothingBeforeTheFirstFixOrAfterTheLast) {
  ReferenceJudge judge(8.0);
  const std::vector<PlaneEstimate> estimates{{10, 0, 0, 0}};
  judge.use(at(-10), estimates);
  judge.fix(fix(0, 10.0, 0.0));
  judge.fix(fix(100, 10.0, 0.0));
  judge.use(at(-5), estimates);
  judge.use(at(101), estimates);
  EXPECT_EQ(judge.compared(), 0u);
  EXPECT_EQ(judge.waiting(), 1u);
}

TEST(ReferenceJudge, AReferenceThatFallsSilentIsNotWaitedForForever) {
  ReferenceJudge judge(8.0);
  judge.fix(fix(0, 10.0, 0.0));
  for (std::int64_t ms = 40; ms < 600'000; ms += 40) judge.use(at(ms), std::vector<PlaneEstimate>{{10, 0, 0, 0}});
  EXPECT_LE(judge.waiting(), 501u) << "20 s, a use every 40 ms";
}

// Perfect estimates against the simulated receiver: the measured error is all of the reference's own error.
// The expectation's interval contains it. A drive counts once.
TEST(ReferenceJudge, ItsOwnErrorIsTheExpectedOne) {
  sim::world::WorldConfig drive;
  drive.duration = Duration::milliseconds(4000);
  sim::world::ObjectConfig car;
  car.x = 35.0;
  car.y = 3.0;
  car.heading = 0.3;
  car.speed = 8.0;
  car.reference = true;
  drive.objects.push_back(car);
  sim::world::ReferenceConfig often, clean, aligned;
  often.excursion_probability = 0.2;
  clean.excursion_probability = 0.0;
  aligned.alignment_baseline_m = 1e4;
  for (const sim::world::ReferenceConfig& config : {sim::world::ReferenceConfig{}, often, clean, aligned}) {
    experiments::results::Moments off;
    double expected = 0.0;
    for (std::uint32_t replication = 0; replication < 1500; ++replication) {
      const sim::world::World world(drive, 5, replication);
      const sim::world::Reference reference(config, drive, 5, replication);
      ReferenceJudge judge(8.0);
      for (std::uint32_t index = 0; index < 40; ++index) {
        const sim::world::Fix fix = reference.fix(index, world);
        judge.fix({.measured_true = fix.measured, .x = fix.x, .y = fix.y, .vx = fix.vx, .vy = fix.vy});
        if (index < 10) continue;
        for (const int ms : {-90, -50, -10}) {
          const TrueTime use = fix.measured + Duration::milliseconds(ms);
          const sim::world::ObjectState truth = world.state_of(fix.object, use);
          judge.use(use, std::vector<PlaneEstimate>{{truth.x, truth.y, 0.0, 0.0}});
        }
      }
      ASSERT_EQ(judge.compared(), 90u);
      expected = expected_square(config, judge.weights());
      off.add(judge.position_rmse() * judge.position_rmse() - expected);
    }
    const experiments::results::Interval interval = experiments::results::interval_of(off, 0.99);
    EXPECT_LT(std::abs(interval.mean), interval.half_width) << "of " << expected;
    EXPECT_LT(interval.half_width, 0.08 * expected) << "too wide to say anything";
  }
}

}  // namespace
}  // namespace ttf::evaluation::accuracy
