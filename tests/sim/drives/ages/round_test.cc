// A drive whose round of cycles has no power of two: sensors measure, and lists are sent, in every fifth cycle of sixty.
#include <gtest/gtest.h>

#include <algorithm>

#include "evaluation/accuracy/drive_measures.h"
#include "schedules/analysis/ages.h"
#include "schedules/check/checker.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "schedules/synthesis/plan/loader.h"
#include "tests/sim/drives/ages/drive_ages.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives::ages {
namespace {

namespace synthesis = schedules::synthesis;

TEST(Round, OfSixtyCyclesDrivesWithinItsBounds) {
  const synthesis::instants::Synthesis made =
      synthesis::instants::synthesize(synthesis::plan::load_plan(shipped("schedules/plans/paper_sixty_cycles.yaml")));
  ASSERT_TRUE(made.found);
  ASSERT_TRUE(schedules::check::check(made.cluster).empty());
  Drive drive("scenarios/paper_scenario1.yaml", fusion::strategies::StrategyKind::kTt);
  drive.cluster = made.cluster;
  drive.scenario.duration = Duration::milliseconds(2500);  // six rounds
  for (const schedules::model::Sensor& sensor : drive.cluster.sensors) EXPECT_EQ(sensor.at.repetition, 5);
  EXPECT_TRUE(std::any_of(drive.cluster.frames.begin(), drive.cluster.frames.end(),
                          [](const schedules::model::FrameSlot& frame) { return frame.repetition == 5; }));
  Ages ages;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    evaluation::accuracy::DriveMeasures measures(evaluation_start(drive.scenario));
    recording::records::Tee tee({&ages, &measures});
    const DriveOutcome outcome = drive.run(tee, seed);
    ages.next_drive();
    EXPECT_EQ(outcome.counts.overruns + outcome.counts.overwritten_lists + outcome.counts.deadlines_missed +
                  outcome.counts.discarded_lists + outcome.counts.slot_problems,
              0u);
    const evaluation::accuracy::DriveSummary summary = measures.finish();
    EXPECT_EQ(summary.out_of_sequence, 0u);
    EXPECT_EQ(summary.missed, 0u);
  }
  const auto paths = schedules::analysis::measurement_ages(drive.cluster);
  ASSERT_EQ(paths.size(), 2u);
  for (const schedules::analysis::AgePath& path : paths) {
    SCOPED_TRACE(drive.cluster.sensor(path.sensor).name);
    const AgeRange &fused = ages.fused[path.sensor], &used = ages.used[path.sensor];
    EXPECT_GT(fused.count, 3u * 65u);
    EXPECT_GE(fused.best, path.fused_best);
    EXPECT_LE(fused.worst, path.fused_worst);
    EXPECT_GE(used.best, path.use_best);
    EXPECT_LE(used.worst, path.newest_worst);
  }
}

}  // namespace
}  // namespace ttf::sim::drives::ages
