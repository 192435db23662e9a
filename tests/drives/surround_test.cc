// Six sensors round the car, and a car that goes round all of them.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "fusion/metrics/consistency.h"
#include "tests/drives/coverage.h"

namespace ttf::drives {
namespace {

using fusion::strategies::StrategyKind;

constexpr ObjectId kRound{0};

class Surround : public testing::TestWithParam<StrategyKind> {};

// A whole turn takes 8.8 s: ahead the laser, the camera with one lens and the long-range radar see the car, aside a corner
// radar alone, behind the stereo camera, too.
TEST_P(Surround, WhoeverGoesRoundKeepsItsName) {
  Drive drive("scenarios/surround.yaml", GetParam());
  drive.scenario.duration = Duration::milliseconds(10'500);
  Coverage coverage(sim::crank::kFirstCycle + Duration::milliseconds(1500));
  const DriveOutcome outcome = drive.run(coverage, 1, false);
  coverage.finish();
  ASSERT_EQ(coverage.objects.size(), 25u);
  const Coverage::Object& round = coverage.objects.at(kRound);
  EXPECT_GT(round.uses, 200);
  EXPECT_GE(round.shown + 5, round.uses);
  EXPECT_EQ(round.tracks.size(), 1u);
  for (const auto& [id, object] : coverage.objects)
    EXPECT_GE(object.shown, 0.95 * object.uses) << "object " << index_of(id);
  EXPECT_EQ(outcome.counts.slot_problems, 0u);
  EXPECT_EQ(outcome.counts.deadlines_missed, 0u);
  EXPECT_EQ(outcome.counts.torn_lists, 0u);
  EXPECT_EQ(outcome.counts.overwritten_lists, 0u);
}

INSTANTIATE_TEST_SUITE_P(EveryStrategy, Surround, testing::ValuesIn(fusion::strategies::kAllStrategies),
                         [](const auto& run) { return std::string(name_of(run.param)); });

}  // namespace
}  // namespace ttf::drives
