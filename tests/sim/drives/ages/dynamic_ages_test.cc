// Measurements whose lists travel in the dynamic segment: drives of that cluster, against the bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>

#include "schedules/analysis/ages.h"
#include "schedules/check/checker.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives::ages {
namespace {

using fusion::strategies::StrategyKind;

struct FusedAges final : recording::records::Sink {
  using recording::records::Sink::on;
  std::map<SensorId, std::vector<Duration>> ages;
  void on(const recording::records::ListFused& list) override {
    if (list.disposition == recording::records::Disposition::kFused ||
        list.disposition == recording::records::Disposition::kFusedLate)
      ages[list.id.sensor].push_back(list.stamp.global - list.measured);
  }
};

class DynamicLists : public testing::TestWithParam<const char*> {};

TEST_P(DynamicLists, AreFusedWithinTheirBounds) {
  for (const StrategyKind strategy : {StrategyKind::kBuff, StrategyKind::kAdva}) {
    Drive drive("scenarios/paper_scenario1.yaml", strategy);
    drive.cluster = schedules::check::load_checked_cluster(shipped(GetParam()));
    FusedAges fused;
    constexpr std::uint64_t kDrives = 8;
    for (std::uint64_t seed = 1; seed <= kDrives; ++seed) drive.run(fused, seed);
    const auto paths = schedules::analysis::measurement_ages(drive.cluster);
    ASSERT_EQ(paths.size(), 2u);
    for (const schedules::analysis::AgePath& path : paths) {
      SCOPED_TRACE(drive.cluster.sensor(path.sensor).name);
      const auto& ages = fused.ages[path.sensor];
      ASSERT_GT(ages.size(), kDrives * 30);
      const auto [best, worst] = std::minmax_element(ages.begin(), ages.end());
      const Duration bound = strategy == StrategyKind::kBuff ? path.buffered_fused_worst : path.fused_worst;
      EXPECT_GE(*best, path.fused_best);
      EXPECT_LE(*worst, bound);
      // Tight: within a fusion period and the variation of preprocessing.
      EXPECT_GT(*worst, bound - Duration::milliseconds(20));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Clusters, DynamicLists,
                         testing::Values("schedules/flexray_demo.yaml", "schedules/paper_dynamic.yaml"),
                         [](const auto& name) { return name.index == 0 ? "Demo" : "Paper"; });

struct Problems final : recording::records::Sink {
  using recording::records::Sink::on;
  std::size_t slots = 0, lists = 0;
  void on(const recording::records::SlotProblem&) override { ++slots; }
  void on(const recording::records::ListFused&) override { ++lists; }
};

// The camera's device is on B only, in its key slot only. Its lists are on A only, the laser's behind a
// message id.
TEST(DynamicAges, OneChannelMessageIdsAndKeySlotOnlyGoThroughADrive) {
  std::ifstream file(shipped("schedules/flexray_demo.yaml"));
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto change = [&](const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  change("\n  camera:\n    flexray: {",
         "\n  camera:\n    flexray: {pChannels: B, pWakeupChannel: B, pKeySlotOnlyEnabled: true, ");
  change("slot: 6, channels: AB", "slot: 6, channels: B");
  change("slot: 23, channels: AB", "slot: 23, channels: A");
  change("pdu: laser_objects, fragments: 2", "pdu: laser_objects, fragments: 2, message_id: 7");
  Drive drive("scenarios/paper_scenario1.yaml", StrategyKind::kAdva);
  drive.cluster = schedules::file::parse_cluster(text, "cluster.yaml");
  ASSERT_TRUE(schedules::check::check(drive.cluster).empty());
  Problems problems;
  drive.run(problems);
  EXPECT_EQ(problems.slots, 0u);
  EXPECT_EQ(problems.lists, 108u);
}

}  // namespace
}  // namespace ttf::sim::drives::ages
