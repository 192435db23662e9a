// Sensors that measure when their host has preprocessed the last measurement, and lists that are fused when they arrive:
// drives of the cluster that has both.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "core/errors.h"
#include "schedules/ages.h"
#include "tests/sim/drive_ages.h"
#include "tests/sim/drive_fixture.h"

namespace ttf {
namespace {

using fusion::StrategyKind;
using testing_support::Ages;
using testing_support::AgeRange;
using testing_support::Drive;

Drive free_running(StrategyKind strategy) {
  Drive drive("scenarios/paper_scenario1.yaml", strategy);
  drive.cluster = schedules::load_checked_cluster(testing_support::shipped("schedules/paper_free_running.yaml"));
  return drive;
}

// By node: when its only task's runs began and ended, in true time, and when its sensor measured.
struct Rounds final : records::Sink {
  using records::Sink::on;
  struct Run {
    TrueTime activated, end;
  };
  std::map<NodeId, std::vector<Run>> runs;
  void on(const records::TaskRun& run) override {
    runs[run.start.node].push_back({run.activated.true_time, run.end.true_time});
  }
};

TEST(FreeRunning, AMeasurementFollowsThePreprocessingOfTheLast) {
  const Drive drive = free_running(StrategyKind::kAdva);
  Rounds rounds;
  const sim::DriveOutcome outcome = drive.run(rounds);
  for (const schedules::Sensor& sensor : drive.cluster.sensors) {
    SCOPED_TRACE(sensor.name);
    const auto& measured = rounds.runs[sensor.device];
    const auto& preprocessed = rounds.runs[sensor.host];
    ASSERT_GT(preprocessed.size(), 40u);
    std::size_t at_once = 0;
    Duration longest{};
    for (std::size_t n = 0; n + 1 < measured.size() && n < preprocessed.size(); ++n) {
      const Duration since = measured[n + 1].activated - measured[n].activated;
      const Duration behind = measured[n + 1].activated - preprocessed[n].end;
      longest = std::max(longest, since);
      // A device counts whole microticks of 25 ns; and it may be off by 1500 ppm.
      EXPECT_GE(behind, Duration{-26});
      EXPECT_GE(since.ns, sensor.period.ns * 9985 / 10000);
      if (behind <= Duration{50})
        ++at_once;
      else
        EXPECT_LE(since.ns, sensor.period.ns * 10015 / 10000 + 50) << "waited without need";
    }
    EXPECT_GT(at_once, measured.size() / 2);
    EXPECT_LT(longest, sensor.longest);
    // As often as in half of the fixed period that the slowest round demands.
    EXPECT_LT((measured.back().activated - measured.front().activated).ns,
              static_cast<std::int64_t>(measured.size()) * sensor.longest.ns * 2 / 3);
  }
  EXPECT_EQ(outcome.counts.overruns, 0u);
  EXPECT_EQ(outcome.counts.overwritten_lists, 0u);
  EXPECT_EQ(outcome.counts.deadlines_missed, 0u);
  EXPECT_EQ(outcome.counts.discarded_lists, 0u);
}

struct Fates final : records::Sink {
  using records::Sink::on;
  std::map<MeasurementId, int> taken;      // by the fusion: how often
  void on(const records::FusionInput& in) override { ++taken[{in.sensor, in.sequence}]; }
};

TEST(FreeRunning, EveryListIsTakenOnceAndWithinItsBounds) {
  for (const StrategyKind strategy : {StrategyKind::kBuff, StrategyKind::kAdva}) {
    const Drive drive = free_running(strategy);
    Ages ages;
    constexpr std::uint64_t kDrives = 20;
    for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
      Fates fates;
      records::Tee tee({&ages, &fates});
      const sim::DriveOutcome outcome = drive.run(tee, seed);
      ages.next_drive();
      EXPECT_EQ(outcome.counts.overruns + outcome.counts.overwritten_lists + outcome.counts.deadlines_missed, 0u);
      std::map<SensorId, std::uint32_t> next;
      for (const auto& [id, times] : fates.taken) {
        EXPECT_EQ(times, 1);
        EXPECT_EQ(id.sequence, next[id.sensor]++) << "none is lost";
      }
    }
    const bool buffered = strategy == StrategyKind::kBuff;
    const auto paths = schedules::measurement_ages(drive.cluster);
    ASSERT_EQ(paths.size(), 2u);
    for (const schedules::AgePath& path : paths) {
      SCOPED_TRACE(std::string(nodes::name_of(strategy)) + ", " + drive.cluster.sensor(path.sensor).name);
      const AgeRange &fused = ages.fused[path.sensor], &used = ages.used[path.sensor];
      EXPECT_GT(fused.count, kDrives * 60);
      EXPECT_GE(fused.best, path.fused_best);
      EXPECT_LE(fused.worst, buffered ? path.buffered_fused_worst : path.fused_worst);
      EXPECT_GE(used.best, path.use_best);
      EXPECT_LE(used.worst, buffered ? path.buffered_newest_worst : path.newest_worst);
      // A list that nothing is before is taken at once.
      if (!buffered) {
        EXPECT_LT(fused.best, path.fused_best + Duration::milliseconds(2));
      }
    }
  }
}

TEST(FreeRunning, TimeTriggeredFusionNeedsInstants) {
  const Drive drive = free_running(StrategyKind::kTt);
  records::Sink nothing;
  try {
    drive.run(nothing);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    ASSERT_EQ(error.findings().size(), 1u);
    EXPECT_EQ(error.findings()[0].key, "nodes.fusion.tasks.fuse_laser.activation");
    EXPECT_GT(error.findings()[0].line, 0);
    EXPECT_NE(error.findings()[0].expected.find("kind time with strategy tt"), std::string::npos);
  }
}

}  // namespace
}  // namespace ttf
