// Ages in simulation against the checker's bounds, over many phases and drifts. adverse_ages_test.cc reaches
// the bounds.
#include <gtest/gtest.h>

#include <string>

#include "schedules/analysis/ages.h"
#include "tests/sim/drives/ages/drive_ages.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives::ages {
namespace {

using fusion::strategies::StrategyKind;

TEST(Ages, SimulatedAgesLieWithinTheBounds) {
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    const Drive drive("scenarios/paper_scenario1.yaml", strategy);
    Ages ages;
    constexpr std::uint64_t kDrives = 40;
    for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
      drive.run(ages, seed);
      ages.next_drive();
    }
    EXPECT_EQ(ages.uses_without_image, 0u);
    const bool buffered = strategy == StrategyKind::kBuff;
    const auto paths = schedules::analysis::measurement_ages(drive.cluster);
    ASSERT_EQ(paths.size(), 2u);
    for (const schedules::analysis::AgePath& path : paths) {
      SCOPED_TRACE(std::string(name_of(strategy)) + ", " + drive.cluster.sensor(path.sensor).name);
      const AgeRange &fused = ages.fused[path.sensor], &used = ages.used[path.sensor];
      EXPECT_GT(fused.count, kDrives * 30);
      EXPECT_GE(fused.best, path.fused_best);
      EXPECT_LE(fused.worst, buffered ? path.buffered_fused_worst : path.fused_worst);
      ASSERT_TRUE(path.reaches_use);
      EXPECT_GT(used.count, kDrives * 60);
      EXPECT_GE(used.best, path.use_best);
      EXPECT_LE(used.worst, buffered ? path.buffered_newest_worst : path.newest_worst);
      // The bound is tight: over so many phases, the worst age comes within a fusion period and a use's.
      EXPECT_GT(used.worst, (buffered ? path.buffered_newest_worst : path.newest_worst) - Duration::milliseconds(50));
    }
  }
}

}  // namespace
}  // namespace ttf::sim::drives::ages
