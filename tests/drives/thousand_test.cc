// Hundreds of objects through a whole cluster: device, preprocessing, FlexRay, fusion, image, feature service.
#include <gtest/gtest.h>

#include <string>

#include "evaluation/accuracy/drive_measures.h"
#include "tests/drives/drive_fixture.h"

namespace ttf {
namespace {

using testing_support::Drive;

class Hundreds : public testing::TestWithParam<fusion::StrategyKind> {};

TEST_P(Hundreds, OfObjectsAreTrackedNearlyAllTheTime) {
  Drive drive("scenarios/thousand.yaml", GetParam());
  constexpr std::size_t kObjects = 400;
  drive.scenario.world.objects.resize(kObjects);
  drive.scenario.duration = drive.scenario.world.duration = Duration::milliseconds(1800);
  drive.scenario.evaluate_from = Duration::milliseconds(1200);
  experiments::DriveMeasures measures(sim::evaluation_start(drive.scenario));
  const sim::DriveOutcome outcome = drive.run(measures);
  const experiments::DriveSummary summary = measures.finish();
  ASSERT_GE(summary.uses, 4);
  EXPECT_EQ(summary.matched + summary.missed, kObjects * summary.uses);
  EXPECT_LT(summary.missed, kObjects * summary.uses / 200) << "of " << kObjects << " at " << summary.uses << " uses";
  EXPECT_LT(summary.spurious, kObjects * summary.uses / 200);
  EXPECT_LT(summary.position_rmse_truth, 0.3);
  EXPECT_EQ(outcome.counts.slot_problems, 0u);
  EXPECT_EQ(outcome.counts.deadlines_missed, 0u);
  EXPECT_EQ(outcome.counts.torn_lists, 0u);
}

INSTANTIATE_TEST_SUITE_P(EveryStrategy, Hundreds, testing::ValuesIn(testing_support::kStrategies),
                         [](const auto& run) { return std::string(nodes::name_of(run.param)); });

}  // namespace
}  // namespace ttf
