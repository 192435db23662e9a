// Sensors that measure when their host has preprocessed the last measurement, and lists fused on arrival.
// Drives of the clusters that have both, over CAN and over either segment of FlexRay.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "core/errors.h"
#include "schedules/analysis/ages.h"
#include "schedules/analysis/responses.h"
#include "schedules/check/checker.h"
#include "tests/sim/drives/ages/drive_ages.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives::ages {
namespace {

using fusion::strategies::StrategyKind;

struct Medium {
  const char* name;
  const char* file;
  bool in_static_slots = false;  // and not where the file has them
};

class FreeRunning : public testing::TestWithParam<Medium> {
 protected:
  static Drive free_running(StrategyKind strategy) {
    Drive drive("scenarios/paper_scenario1.yaml", strategy);
    std::string text = schedules::file::load_cluster(shipped(GetParam().file)).text;
    if (GetParam().in_static_slots) {
      text.replace(text.find("slot: 35"), 8, "slot: 6");
      text.replace(text.find("slot: 44"), 8, "slot: 15");
    }
    drive.cluster = schedules::file::parse_cluster(text, "cluster.yaml");
    EXPECT_TRUE(schedules::check::check(drive.cluster).empty());
    return drive;
  }
};
INSTANTIATE_TEST_SUITE_P(Over, FreeRunning,
                         testing::Values(Medium{"Can", "schedules/paper_free_running.yaml"},
                                         Medium{"DynamicSegment", "schedules/paper_free_flexray.yaml"},
                                         Medium{"StaticSegment", "schedules/paper_free_flexray.yaml", true}),
                         [](const auto& one) { return std::string(one.param.name); });

// By node: begin and end of its only task's executions, in true time, and its sensor's measurements.
struct Rounds final : recording::records::Sink {
  using recording::records::Sink::on;
  struct Run {
    TrueTime activated, end;
  };
  std::map<NodeId, std::vector<Run>> runs;
  void on(const recording::records::TaskRun& run) override {
    runs[run.start.node].push_back({run.activated.true_time, run.end.true_time});
  }
};

TEST_P(FreeRunning, AMeasurementFollowsThePreprocessingOfTheLast) {
  const Drive drive = free_running(StrategyKind::kAdva);
  Rounds rounds;
  const DriveOutcome outcome = drive.run(rounds);
  for (const schedules::model::Sensor& sensor : drive.cluster.sensors) {
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
      // A device counts whole microticks of 25 ns, and may be off by 1500 ppm.
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

// The largest effect of corrections on 5 ms.
constexpr Duration kCorrections = Duration::microseconds(25);

struct Fates final : recording::records::Sink {
  using recording::records::Sink::on;
  std::map<MeasurementId, int> taken;  // by the fusion: how often
  void on(const recording::records::FusionInput& in) override { ++taken[{in.sensor, in.sequence}]; }
};

// Responses of one node's tasks, by its global time.
struct Responses final : recording::records::Sink {
  using recording::records::Sink::on;
  explicit Responses(NodeId which) : node(which) {}
  NodeId node;
  std::map<std::uint8_t, Duration> longest, closest;  // from activation to end; between activations
  void on(const recording::records::TaskRun& run) override {
    if (run.start.node != node) return;
    longest[run.task] = std::max(longest[run.task], run.end.global - run.activated.global);
    const auto last = last_.find(run.task);
    if (last != last_.end()) {
      const Duration since = run.activated.global - last->second;
      closest[run.task] = std::min(closest.try_emplace(run.task, since).first->second, since);
    }
    last_[run.task] = run.activated.global;
  }
  void next_drive() { last_.clear(); }

 private:
  std::map<std::uint8_t, GlobalTime> last_;
};

TEST_P(FreeRunning, EveryListIsTakenOnceAndWithinItsBounds) {
  for (const StrategyKind strategy : {StrategyKind::kBuff, StrategyKind::kAdva}) {
    const Drive drive = free_running(strategy);
    Ages ages;
    const NodeId fusion = *drive.cluster.find_node("fusion");
    Responses responses(fusion);
    constexpr std::uint64_t kDrives = 8;
    for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
      Fates fates;
      recording::records::Tee tee({&ages, &fates, &responses});
      const DriveOutcome outcome = drive.run(tee, seed);
      ages.next_drive();
      responses.next_drive();
      EXPECT_EQ(outcome.counts.overruns + outcome.counts.overwritten_lists + outcome.counts.deadlines_missed, 0u);
      std::map<SensorId, std::uint32_t> next;
      for (const auto& [id, times] : fates.taken) {
        EXPECT_EQ(times, 1);
        EXPECT_EQ(id.sequence, next[id.sensor]++) << "none is lost";
      }
    }
    const bool buffered = strategy == StrategyKind::kBuff;
    const auto paths = schedules::analysis::measurement_ages(drive.cluster);
    ASSERT_EQ(paths.size(), 2u);
    for (const schedules::analysis::AgePath& path : paths) {
      SCOPED_TRACE(std::string(name_of(strategy)) + ", " + drive.cluster.sensor(path.sensor).name);
      const AgeRange &fused = ages.fused[path.sensor], &used = ages.used[path.sensor];
      EXPECT_GT(fused.count, kDrives * 60);
      EXPECT_GE(fused.best, path.fused_best);
      EXPECT_LE(fused.worst, buffered ? path.buffered_fused_worst : path.fused_worst);
      EXPECT_GE(used.best, path.use_best);
      EXPECT_LE(used.worst, buffered ? path.buffered_newest_worst : path.newest_worst);
      // A list with a free way is taken at once.
      if (!buffered) {
        EXPECT_LT(fused.best, path.fused_best + Duration::milliseconds(2));
      }
    }
    const auto bounds = schedules::analysis::worst_responses(drive.cluster, fusion);
    ASSERT_TRUE(bounds.has_value());
    for (const auto& [task, longest] : responses.longest) {
      SCOPED_TRACE(drive.cluster.node(fusion).tasks[task].name);
      EXPECT_LE(longest, (*bounds)[task].worst + kCorrections);
      EXPECT_GE(responses.closest[task], *(*bounds)[task].gap - kCorrections);
    }
    EXPECT_EQ(responses.longest.size(), 3u);
  }
}

TEST_P(FreeRunning, TimeTriggeredFusionNeedsInstants) {
  const Drive drive = free_running(StrategyKind::kTt);
  recording::records::Sink nothing;
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
}  // namespace ttf::sim::drives::ages
