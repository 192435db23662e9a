// The time-triggered schedule at its best (schedules/paper_fitted.yaml): drives show its phases' purpose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "schedules/analysis/ages.h"
#include "schedules/check/checker.h"
#include "tests/sim/drives/ages/drive_ages.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives::ages {
namespace {

struct InOrder final : recording::records::Sink {
  using recording::records::Sink::on;
  GlobalTime newest{};
  std::size_t fused = 0, behind = 0, held = 0;
  void on(const recording::records::ListFused& list) override {
    held += list.disposition == recording::records::Disposition::kHeld ? 1u : 0u;
    fused += list.disposition == recording::records::Disposition::kFused ? 1u : 0u;
    behind += list.measured < newest || list.disposition == recording::records::Disposition::kFusedLate ? 1u : 0u;
    newest = std::max(newest, list.measured);
  }
};

// Lists of one car, which are short, and of as many objects as fit.
TEST(FittedSchedule, EveryUseFindsBothSensorsNewestListsAtTheSameAge) {
  for (const auto& [file, drives] :
       {std::pair{"scenarios/paper_scenario1.yaml", 20u}, std::pair{"scenarios/crowd_25.yaml", 2u}}) {
    SCOPED_TRACE(file);
    Drive drive(file, fusion::strategies::StrategyKind::kTt);
    drive.cluster = schedules::check::load_checked_cluster(shipped("schedules/paper_fitted.yaml"));
    drive.scenario.duration = Duration::milliseconds(2500);
    Ages ages;
    for (std::uint64_t seed = 1; seed <= drives; ++seed) {
      InOrder order;
      recording::records::Tee tee({&ages, &order});
      const DriveOutcome outcome = drive.run(tee, seed);
      ages.next_drive();
      EXPECT_EQ(outcome.counts.overruns + outcome.counts.overwritten_lists + outcome.counts.deadlines_missed +
                    outcome.counts.discarded_lists,
                0u);
      // Two lists each 34.4 ms, without losses or waits.
      EXPECT_GE(order.fused, 2u * 69u);
      EXPECT_EQ(order.behind, 0u);
      EXPECT_EQ(order.held, 0u);
    }
    const auto paths = schedules::analysis::measurement_ages(drive.cluster);
    ASSERT_EQ(paths.size(), 2u);
    for (const schedules::analysis::AgePath& path : paths) {
      SCOPED_TRACE(drive.cluster.sensor(path.sensor).name);
      const AgeRange &fused = ages.fused[path.sensor], &used = ages.used[path.sensor];
      EXPECT_GE(fused.best, path.fused_best);
      EXPECT_LE(fused.worst, path.fused_worst);
      // The newest one is of this period at every use, and no older than its way; the clocks are the rest.
      EXPECT_GE(used.best, path.use_best);
      EXPECT_LE(used.worst, path.use_worst);
      EXPECT_LT(used.worst - used.best, Duration::microseconds(20));
      EXPECT_LT(path.newest_worst - path.use_worst, Duration::microseconds(20));
    }
  }
}

}  // namespace
}  // namespace ttf::sim::drives::ages
