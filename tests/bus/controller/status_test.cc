// The controller's status for its host: each slot's, and clock synchronisation's.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "bus/controller/sync_collector.h"
#include "tests/bus/alone.h"
#include "tests/bus/startup_cluster.h"

namespace ttf::bus::controller {
namespace {

constexpr SlotSeen kNothing{};
constexpr SlotSeen kValid{.valid_frame = true};

TEST(SlotSeen, AValidFrameIsSeenOnItsChannelOnly) {
  Alone node;
  Frame::status(2, 0).arrive(node);
  node.run_to(0, 840);
  EXPECT_EQ(node.controller.slot_status(2, Channel::kA), kValid);
  EXPECT_EQ(node.controller.slot_status(2, Channel::kB), kNothing);
  EXPECT_EQ(node.controller.slot_status(3, Channel::kA), kNothing);  // missing
  EXPECT_EQ(node.controller.slot_status(1, Channel::kA),
            kNothing);  // the own slot: a controller does not receive itself
}

// The exact instants of publication, and of replacement.
TEST(SlotSeen, StandsFromTheEndOfOneStaticSegmentToTheEndOfTheNext) {
  Alone node;
  std::vector<std::pair<std::int64_t, bool>> reported;
  node.reports.on_static_segment_ended = [&](std::int64_t cycle) {
    reported.emplace_back(cycle, node.controller.slot_status(2, Channel::kA).valid_frame);
  };
  Frame::status(2, 0).arrive(node);
  EXPECT_EQ(node.controller.slot_status(2, Channel::kA), kNothing);  // not yet
  node.controller.advance(Alone::at(0, 840) - Microticks{1});
  EXPECT_TRUE(reported.empty());
  node.run_to(0, 840);
  EXPECT_EQ(reported.size(), 1u);
  node.controller.advance(Alone::at(1, 840) - Microticks{1});
  EXPECT_EQ(node.controller.slot_status(2, Channel::kA), kValid);
  node.run_to(1, 840);
  EXPECT_EQ(node.controller.slot_status(2, Channel::kA), kNothing);
  Frame::status(2, 2).arrive(node);
  node.run_to(3);
  EXPECT_EQ(reported, (std::vector<std::pair<std::int64_t, bool>>{{0, true}, {1, false}, {2, true}}));
}

TEST(SlotSeen, EveryKindOfError) {
  Alone node;
  Frame wrong_cycle = Frame::status(2, 0);
  wrong_cycle.header.cycle = 5;
  wrong_cycle.arrive(node);
  const Frame broken = Frame::status(3, 0);
  auto bytes = broken.bytes();
  bytes[9] ^= std::byte{1};
  node.controller.advance({broken.start});
  node.controller.receive(received(Channel::kA, {broken.start}, {broken.start + 1000}, bytes));
  Frame crossing = Frame::status(3, 0, Channel::kB);
  crossing.start = Alone::at(0, 84 * 3).value - 500;  // into slot 4
  crossing.arrive(node);
  Frame against_own = Frame::status(5, 0);
  against_own.arrive(node);
  node.run_to(1);
  EXPECT_EQ(node.controller.slot_status(2, Channel::kA), SlotSeen{.content_error = true});
  EXPECT_EQ(node.controller.slot_status(3, Channel::kA), SlotSeen{.syntax_error = true});
  EXPECT_EQ(node.controller.slot_status(3, Channel::kB), SlotSeen{.boundary_violation = true});
  EXPECT_EQ(node.controller.slot_status(4, Channel::kB), SlotSeen{.boundary_violation = true});
  EXPECT_EQ(node.controller.slot_status(5, Channel::kA),
            (SlotSeen{.syntax_error = true, .transmission_conflict = true}));
  EXPECT_EQ(node.controller.slot_status(5, Channel::kB), kNothing);
}

TEST(SlotSeen, AValidFrameWithAnElementBehindItIsBoth) {
  Alone node;
  Frame second = Frame::status(2, 0);
  second.start += 1500;
  Frame::status(2, 0).arrive(node);
  second.arrive(node);
  node.run_to(1);
  EXPECT_EQ(node.controller.slot_status(2, Channel::kA), (SlotSeen{.valid_frame = true, .syntax_error = true}));
}

// The last slot's frame goes on beyond the segment. The status at the segment's end lacks it, a later one has
// it.
TEST(SlotSeen, AFrameThatOutlastsTheSegmentIsAddedWhenItIsOver) {
  Alone node;
  Frame late = Frame::status(10, 0);
  late.start = Alone::at(0, 840).value - 500;
  bool at_the_end = true;
  node.reports.on_static_segment_ended = [&](std::int64_t cycle) {
    if (cycle == 0) at_the_end = node.controller.slot_status(10, Channel::kA).boundary_violation;
  };
  late.arrive(node);
  EXPECT_FALSE(at_the_end);
  EXPECT_EQ(node.controller.slot_status(10, Channel::kA), SlotSeen{.boundary_violation = true});
  node.run_to(2);
  EXPECT_EQ(node.controller.slot_status(10, Channel::kA), kNothing);
}

// Four nodes from power-on: segments are reported from the leading node's first cycle on, without a gap.
TEST(SlotSeen, IsReportedInEveryCycleAlsoDuringStartup) {
  Rig rig(startup_cluster(4), {0, 0, 0, 0}, {}, std::vector<TrueTime>(4, Rig::kStart));
  rig.run_cycles(60);
  for (std::size_t n = 0; n < 4; ++n) {
    ASSERT_EQ(rig.controller(n).state().kind, poc::PocKind::kNormalActive) << n;
    const auto& cycles = rig.reports(n).static_segments;
    ASSERT_GT(cycles.size(), 20u);
    const auto last_start = std::find(cycles.rbegin(), cycles.rend(), cycles.front()).base() - 1;
    for (auto at = last_start + 1; at != cycles.end(); ++at) EXPECT_EQ(*at, *(at - 1) + 1);
    for (int slot = 1; slot <= 4; ++slot)
      EXPECT_EQ(rig.controller(n).slot_status(slot, Channel::kB), static_cast<int>(n) == slot - 1 ? kNothing : kValid);
  }
}

TEST(SyncStatus, CountsValidSyncFramesByChannelAndCycle) {
  Alone node;
  Frame::status(2, 0).arrive(node);
  Frame::status(3, 0).arrive(node);
  Frame::status(3, 0, Channel::kB).arrive(node);
  node.run_to(0, 840);
  SyncStatus status = node.controller.sync_status();
  EXPECT_EQ(status, (SyncStatus{.VSAE = 3, .VSBE = 2}));  // with its own
  Frame::status(4, 1, Channel::kB).arrive(node);
  Frame wrong = Frame::status(2, 1);
  wrong.header.cycle = 9;
  Frame odd_list = Frame::status(9, 1);  // valid, but no sync frame
  wrong.arrive(node);
  odd_list.arrive(node);
  node.controller.advance(Alone::at(1, 840) - Microticks{1});
  EXPECT_EQ(node.controller.sync_status(), status);  // until the segment is over
  node.run_to(1, 840);
  status = node.controller.sync_status();
  EXPECT_EQ(status, (SyncStatus{.VSAE = 3, .VSAO = 1, .VSBE = 2, .VSBO = 2}));
  node.run_to(2, 840);
  EXPECT_EQ(node.controller.sync_status(), (SyncStatus{.VSAE = 1, .VSAO = 1, .VSBE = 1, .VSBO = 2}));
}

// gSyncNodeMax bounds the frames used, not the frames counted; the count itself ends at 15.
TEST(SyncStatus, CountsBeyondWhatIsUsedUpTo15) {
  SyncCollector collector(2);
  collector.start_cycle(0);
  for (int frame = 1; frame <= 20; ++frame) {
    collector.received(frame, schedules::model::Channels::kA, {}, false);
    if (frame <= 3) collector.received(frame, schedules::model::Channels::kB, {}, false);
    EXPECT_EQ(collector.valid(Channel::kA), std::min(frame, 15));
  }
  EXPECT_EQ(collector.valid(Channel::kB), 3);
  EXPECT_EQ(collector.measurements().even_count, 2);
  collector.start_cycle(1);
  EXPECT_EQ(collector.valid(Channel::kA), 0);
  collector.own(7, schedules::model::Channels::kB);
  EXPECT_EQ(collector.valid(Channel::kA), 0);
  EXPECT_EQ(collector.valid(Channel::kB), 1);
}

// A node without a sync frame of its own receives one other node in every second cycle.
TEST(SyncStatus, MissingTermsAndTheirCount) {
  schedules::model::Cluster cluster = small_cluster(4);
  cluster.nodes[0].flexray->pKeySlotUsedForSync = cluster.nodes[0].flexray->pKeySlotUsedForStartup = false;
  cluster.flexray.gMaxWithoutClockCorrectionPassive = cluster.flexray.gMaxWithoutClockCorrectionFatal = 15;
  Alone node(0, cluster);
  node.run_to(2);
  EXPECT_EQ(node.controller.sync_status(), (SyncStatus{.MOCS = true, .MRCS = true, .vClockCorrectionFailed = 1}));
  Frame::status(2, 3).arrive(node);
  node.run_to(4);
  EXPECT_EQ(node.controller.sync_status(), (SyncStatus{.VSAO = 1, .MRCS = true, .vClockCorrectionFailed = 2}));
  Frame::status(2, 4).arrive(node);
  Frame::status(2, 5).arrive(node);
  node.run_to(6);
  EXPECT_EQ(node.controller.sync_status(), (SyncStatus{.VSAE = 1, .VSAO = 1}));
}

// Limits: 400 microticks of offset, 121 of rate.
TEST(SyncStatus, LimitsReached) {
  const auto late_by = [](std::int64_t even, std::int64_t odd) {
    Alone node;
    for (const std::int64_t cycle : {0, 1})
      for (const int slot : {2, 3, 4}) {
        Frame frame = Frame::status(slot, cycle);
        frame.start += cycle == 0 ? even : odd;
        frame.arrive(node);
      }
    node.run_to(1, 900);
    return node.controller.sync_status();
  };
  const SyncStatus in_order = late_by(400, 400), offset = late_by(402, 402), rate = late_by(0, 124);
  EXPECT_FALSE(in_order.OCLR || in_order.RCLR);
  EXPECT_TRUE(offset.OCLR);
  EXPECT_FALSE(offset.RCLR);
  EXPECT_FALSE(rate.OCLR);
  EXPECT_TRUE(rate.RCLR);
  EXPECT_FALSE(offset.MOCS || rate.MRCS);
}

// Back at power-on: a new schedule starts without the old one's status.
TEST(SyncStatus, BeginsAnewWithTheSchedule) {
  Alone node;
  Frame::status(2, 0).arrive(node);
  node.run_to(2);
  EXPECT_EQ(node.controller.sync_status().VSAE, 2);
  node.controller.start_integrated({Alone::at(3, 0), 0});
  EXPECT_EQ(node.controller.sync_status(), SyncStatus{});
  EXPECT_EQ(node.controller.slot_status(2, Channel::kA), kNothing);
}

}  // namespace
}  // namespace ttf::bus::controller
