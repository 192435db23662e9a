// The dynamic segment in whole clusters. Priority goes by frame id, a frame that does not fit waits, and each
// channel counts separately.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/random.h"
#include "schedules/analysis/minislots.h"
#include "tests/bus/dynamic_cluster.h"

namespace ttf::bus::controller {
namespace {

using schedules::model::Channels;

TEST(DynamicSegment, AListIsSentOnceAndArrives) {
  Rig rig(dynamic_cluster(3), {0, 0, 0}, Duration{500});
  rig.run_cycles(4);
  EXPECT_TRUE(dynamic_frames(rig, 1).empty());
  write(rig, 1, 7);
  rig.run_cycles(12);
  ASSERT_EQ(dynamic_frames(rig, 1).size(), 1u);
  EXPECT_EQ(dynamic_frames(rig, 1)[0].cycle, 4);
  EXPECT_TRUE(dynamic_frames(rig, 1)[0].last || dynamic_frames(rig, 1, Channel::kB)[0].last);
  EXPECT_EQ(arrived(rig, 0, PduId{3}), std::vector<std::uint32_t>{7});
  EXPECT_EQ(arrived(rig, 2, PduId{3}), std::vector<std::uint32_t>{7});
  for (std::size_t n = 0; n < 3; ++n) EXPECT_TRUE(rig.reports(n).problems.empty());
}

// A frame of 8 bytes lasts 172 bits = 17.2 us. It begins at the action point of minislot 1 (3 MT in) and
// would end at 20.2 MT of the segment. So its DTS lasts until the action point of minislot 5 (23 MT).
// Minislot 6 is idle, and the next slot begins in 7.
TEST(DynamicSegment, TheLowerIdentifierGoesFirstAndTheOthersWaitForItsEnd) {
  Rig rig(dynamic_cluster(3), {0, 0, 0});
  rig.run_cycles(2);
  for (const std::size_t node : {2u, 0u, 1u}) write(rig, node, 1);
  rig.run_cycles(4);
  std::vector<std::int64_t> minislots;
  for (std::size_t node = 0; node < 3; ++node) {
    ASSERT_EQ(dynamic_frames(rig, node).size(), 1u);
    const Reports::Sent sent = dynamic_frames(rig, node)[0];
    const auto cycle = std::find_if(rig.reports(node).cycle_starts.begin(), rig.reports(node).cycle_starts.end(),
                                    [&](const auto& started) { return started.first == sent.cycle; });
    ASSERT_NE(cycle, rig.reports(node).cycle_starts.end());
    const std::int64_t macrotick = ((sent.start - cycle->second).value + 20) / 40;
    EXPECT_EQ((macrotick - kSegment) % 5, 3);  // the minislot's action point
    minislots.push_back((macrotick - kSegment) / 5 + 1);
  }
  EXPECT_EQ(minislots, (std::vector<std::int64_t>{1, 7, 13}));
  // The same as the schedule's analysis; this case reaches its bound.
  const auto& frames = rig.cluster().frames;
  for (std::size_t node = 0; node < 3; ++node)
    EXPECT_EQ(schedules::analysis::latest_turn(rig.cluster(), frames[frames.size() - 3 + node]), minislots[node]);
}

TEST(DynamicSegment, AFrameThatDoesNotFitWaitsForTheNextCycle) {
  schedules::model::Cluster cluster = dynamic_cluster(3);
  for (auto& node : cluster.nodes) node.flexray->pLatestTx = 9;
  Rig rig(cluster, {0, 0, 0});
  rig.run_cycles(2);
  for (std::size_t node = 0; node < 3; ++node) write(rig, node, 1);
  rig.run_cycles(6);
  EXPECT_EQ(dynamic_frames(rig, 0)[0].cycle, 2);
  EXPECT_EQ(dynamic_frames(rig, 1)[0].cycle, 2);
  ASSERT_EQ(dynamic_frames(rig, 2).size(), 1u);
  EXPECT_EQ(dynamic_frames(rig, 2)[0].cycle, 3);
}

TEST(DynamicSegment, TheChannelsCountOnTheirOwn) {
  schedules::model::Cluster cluster = dynamic_cluster(3);
  cluster.frames[cluster.frames.size() - 3].channels = Channels::kA;  // slot 11 on A only
  Rig rig(cluster, {0, 0, 0});
  rig.run_cycles(2);
  write(rig, 0, 1);
  write(rig, 1, 1);
  rig.run_cycles(4);
  ASSERT_EQ(dynamic_frames(rig, 1, Channel::kA).size(), 1u);
  ASSERT_EQ(dynamic_frames(rig, 1, Channel::kB).size(), 1u);
  // On B slot 11 is unused: slot 12 comes one minislot later.
  EXPECT_GT(dynamic_frames(rig, 1, Channel::kA)[0].start, dynamic_frames(rig, 1, Channel::kB)[0].start);
  for (std::size_t n = 0; n < 3; ++n) EXPECT_TRUE(rig.reports(n).problems.empty());
}

// Any load, any clocks: no collision, no loss. Every list reaches every node once, in order.
TEST(DynamicSegment, RandomLoadOnDriftingClocks) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    RandomStream draw({seed, 0, Purpose::kTest, 0, 0});
    std::vector<std::int64_t> drifts;
    for (int n = 0; n < 4; ++n) drifts.push_back(draw.integer(-300'000, 300'000));
    Rig rig(dynamic_cluster(4), drifts, Duration{draw.integer(0, 800)});
    rig.run_cycles(20);  // until the rates agree
    for (std::size_t n = 0; n < 4; ++n) rig.reports(n).problems.clear();
    std::vector<std::uint32_t> written(4, 0);
    for (int cycle = 20; cycle < 80; ++cycle) {
      for (std::size_t n = 0; n < 4; ++n)
        if (draw.integer(0, 2) == 0 && dynamic_frames(rig, n).size() == written[n]) write(rig, n, ++written[n]);
      rig.run_cycles(cycle + 1);
    }
    rig.run_cycles(90);
    for (std::size_t n = 0; n < 4; ++n) {
      ASSERT_TRUE(rig.reports(n).problems.empty())
          << "seed " << seed << " node " << n << " slot " << rig.reports(n).problems[0].slot << " status "
          << to_text(rig.reports(n).problems[0].status);
      for (std::size_t m = 0; m < 4; ++m) {
        if (m == n) continue;
        std::vector<std::uint32_t> all(written[m]);
        for (std::uint32_t s = 0; s < written[m]; ++s) all[s] = s + 1;
        ASSERT_EQ(arrived(rig, n, static_cast<PduId>(2 + m)), all) << "seed " << seed;
      }
    }
  }
}

}  // namespace
}  // namespace ttf::bus::controller
