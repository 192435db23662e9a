// Hundreds of objects through a whole cluster: device, preprocessing, FlexRay, fusion, image, feature service.
#include <gtest/gtest.h>

#include <string>

#include "evaluation/accuracy/drive_measures.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives {
namespace {

class Hundreds : public testing::TestWithParam<fusion::strategies::StrategyKind> {};

TEST_P(Hundreds, OfObjectsAreTrackedNearlyAllTheTime) {
  Drive drive("scenarios/thousand.yaml", GetParam());
  constexpr std::size_t kObjects = 400;
  drive.scenario.world.objects.resize(kObjects);
  drive.scenario.duration = drive.scenario.world.duration = Duration::milliseconds(1800);
  drive.scenario.evaluate_from = Duration::milliseconds(1200);
  evaluation::accuracy::DriveMeasures measures(evaluation_start(drive.scenario));
  const DriveOutcome outcome = drive.run(measures);
  const evaluation::accuracy::DriveSummary summary = measures.finish();
  ASSERT_GE(summary.uses, 4);
  EXPECT_EQ(summary.matched + summary.missed, kObjects * summary.uses);
  EXPECT_LT(summary.missed, kObjects * summary.uses / 200) << "of " << kObjects << " at " << summary.uses << " uses";
  EXPECT_LT(summary.spurious, kObjects * summary.uses / 200);
  EXPECT_LT(summary.position_rmse_truth, 0.3);
  EXPECT_EQ(outcome.counts.slot_problems, 0u);
  EXPECT_EQ(outcome.counts.deadlines_missed, 0u);
  EXPECT_EQ(outcome.counts.torn_lists, 0u);
}

INSTANTIATE_TEST_SUITE_P(EveryStrategy, Hundreds, testing::ValuesIn(fusion::strategies::kAllStrategies),
                         [](const auto& run) { return std::string(name_of(run.param)); });

}  // namespace
}  // namespace ttf::sim::drives
