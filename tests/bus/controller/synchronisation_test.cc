// Clock synchronisation in the controllers: measurement, the instants of correction, and the convergence of
// clusters.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bus/wire/flexray_frame.h"
#include "tests/bus/alone.h"

namespace ttf::bus::controller {
namespace {

using schedules::model::Channel;

// A single node 3. Sync frames of nodes 0..2 arrive as the test says, late by so many microticks.
struct SyncListener {
  schedules::model::Cluster cluster = small_cluster(4);
  NoPort port;
  Reports reports;
  FlexRayController controller;

  explicit SyncListener(schedules::model::Cluster made = small_cluster(4))
      : cluster(std::move(made)), controller(cluster, NodeId{3}, port, reports) {
    controller.start_integrated({{0}, 0});
  }

  // In the running cycle, which must not be past its slot.
  void sync_frame(int slot, int late, Channel channel) {
    wire::FrameHeader header;
    header.frame_id = static_cast<std::uint16_t>(slot);
    header.cycle = static_cast<std::uint8_t>(controller.clock()->cycle() % 64);
    header.sync = header.startup = true;
    const std::vector<std::byte> payload(16);
    std::vector<std::byte> bytes(wire::kMaxFrameBytes);
    bytes.resize(wire::encode_frame(header, channel, payload, bytes));
    const Microticks start = controller.clock()->start_of({84 * (slot - 1) + 7}) + Microticks{late};
    controller.receive(received(channel, start, start + Microticks{1000}, bytes));
  }
  void both(int slot, int late) {
    sync_frame(slot, late, Channel::kA);
    sync_frame(slot, late, Channel::kB);
  }
  void next_cycle() { controller.advance(controller.clock()->cycle_end()); }
  void end_static_segment() { controller.advance(controller.clock()->start_of({840})); }
};

// The own frame's 0, and those late by 10, 20 and 300: one dropped at each end, (10 + 20) / 2.
TEST(Deviations, OffsetIsTheMidpointWithTheOwnFrameAsZero) {
  SyncListener node;
  node.next_cycle();
  node.both(1, 10);
  node.both(2, 300);
  node.both(3, 20);
  const Microticks start = node.controller.clock()->cycle_start();
  const Microticks correction_phase = node.controller.clock()->start_of({900});
  node.end_static_segment();
  ASSERT_EQ(node.reports.corrected.size(), 1u);
  EXPECT_EQ(node.reports.corrected[0].cycle, 1);
  EXPECT_EQ(node.reports.corrected[0].offset.value, 15);
  // Applied at the odd cycle's end: before the correction phase the clock is unchanged.
  EXPECT_EQ(node.controller.clock()->start_of({900}), correction_phase);
  EXPECT_EQ(node.controller.clock()->cycle_end(), start + Microticks{kMicroPerCycle + 15});
}

TEST(Deviations, TheSmallerChannelCounts) {
  SyncListener node;
  node.next_cycle();
  node.sync_frame(1, 30, Channel::kA);
  node.sync_frame(1, 22, Channel::kB);
  node.end_static_segment();
  EXPECT_EQ(node.reports.corrected[0].offset.value, 11);  // (0 + 22) / 2
}

TEST(Deviations, EvenCyclesDoNotCorrectTheOffset) {
  SyncListener node;
  node.both(1, 50);
  node.end_static_segment();
  EXPECT_TRUE(node.reports.corrected.empty());
  EXPECT_EQ(node.controller.clock()->offset_correction(), 0);
  node.next_cycle();  // an odd cycle without arrivals: only its own frame
  node.end_static_segment();
  EXPECT_EQ(node.reports.corrected[0].offset.value, 0);
}

TEST(Deviations, DelayCompensationIsTakenOffPerChannel) {
  schedules::model::Cluster cluster = small_cluster(4);
  cluster.nodes[3].flexray->pDelayCompensationA = 10;
  cluster.nodes[3].flexray->pDelayCompensationB = 4;
  SyncListener node(cluster);
  node.next_cycle();
  node.sync_frame(1, 30, Channel::kA);  // 20
  node.sync_frame(2, 30, Channel::kB);  // 26
  node.end_static_segment();
  EXPECT_EQ(node.reports.corrected[0].offset.value, 20);  // the middle of 0, 20, 26
}

TEST(Deviations, FramesWithoutSyncIndicatorAreNotMeasured) {
  Rig rig(small_cluster(2), {0, 0});
  rig.on_the_way = [](TestMedium::Arrival& frame) {
    frame.start += Duration{1000};  // all frames outside key slots come 40 microticks late
    const auto decoded = wire::decode_frame(frame.channel, frame.bytes);
    if (decoded.header.sync) frame.start = frame.start - Duration{1000};
    return true;
  };
  rig.run_cycles(10);
  for (const auto& corrected : rig.reports(1).corrected) EXPECT_LE(std::abs(corrected.offset.value), 1);
}

TEST(Rates, ComeFromOddMinusEvenAndHoldFromTheNextEvenCycle) {
  SyncListener node;
  node.both(1, 5);
  node.both(2, 5);
  node.both(3, 5);
  node.next_cycle();
  node.both(1, 45);
  node.both(2, 45);
  node.both(3, 45);
  node.end_static_segment();
  ASSERT_EQ(node.reports.corrected.size(), 1u);
  EXPECT_EQ(node.reports.corrected[0].rate.value, 38);       // 40, damped by 2
  EXPECT_EQ(node.controller.clock()->rate_correction(), 0);  // not yet in force
  node.next_cycle();
  EXPECT_EQ(node.controller.clock()->cycle(), 2);
  EXPECT_EQ(node.controller.clock()->rate_correction(), 38);
  node.next_cycle();
  EXPECT_EQ(node.controller.clock()->rate_correction(), 38);  // both cycles of the pair
  node.next_cycle();
  // The pair had no other frames. The own frame alone gives zero, and damping takes two.
  EXPECT_EQ(node.controller.clock()->rate_correction(), 36);
}

TEST(Rates, DeviationsOfAnEarlierPairAreForgotten) {
  SyncListener node;
  node.both(1, 5);
  for (int cycle = 0; cycle < 3; ++cycle) node.next_cycle();
  node.both(1, 45);  // odd cycle 3; even cycle 2 had no arrivals
  node.end_static_segment();
  EXPECT_EQ(node.reports.corrected.back().rate.value, 0);
}

struct Drifts {
  std::vector<std::int64_t> drifts_ppb;
};
class Convergence : public testing::TestWithParam<Drifts> {};

TEST_P(Convergence, FromUncorrectedRatesToTheAssumedPrecision) {
  const auto& drifts = GetParam().drifts_ppb;
  Rig rig(small_cluster(static_cast<int>(drifts.size())), drifts);
  rig.run_cycles(40);
  Duration worst{};
  for (int quarter = 160; quarter < 1600; ++quarter) {
    const TrueTime at = Rig::kStart + Duration::microseconds(250) * quarter;
    rig.run_until(at);
    worst = std::max(worst, rig.precision(at));
  }
  EXPECT_LT(worst, kAssumedPrecision);
  EXPECT_GT(worst, Duration{});
  for (std::size_t n = 0; n < drifts.size(); ++n) {
    EXPECT_TRUE(rig.reports(n).problems.empty()) << n;
    EXPECT_FALSE(rig.reports(n).corrected.back().offset.missing);
    EXPECT_FALSE(rig.reports(n).corrected.back().rate.limit_reached);
  }
}

INSTANTIATE_TEST_SUITE_P(Drifts, Convergence,
                         testing::Values(Drifts{{1'500'000, -1'500'000}}, Drifts{{1'500'000, 0, -1'500'000}},
                                         Drifts{{1'500'000, 1'400'000, -1'500'000}},
                                         Drifts{{1'500'000, -1'500'000, 1'500'000, -1'500'000}},
                                         Drifts{{1'500'000, 500'000, -500'000, -1'500'000}}, Drifts{{1, 0, 2, -3}}));

// An uncompensated delay of 100 microticks lengthens every double cycle by as much, 1250 ppm. A compensated
// one does not. The cluster then keeps the mean of its clocks, 0 ppm, except for the part that damping leaves
// to the offset correction.
TEST(Convergence, ACompensatedDelayDoesNotSlowTheClusterDown) {
  constexpr std::int64_t kCycles = 400;
  const TrueTime end = Rig::kStart + Duration::milliseconds(kCycles);
  for (const bool compensated : {true, false}) {
    schedules::model::Cluster cluster = small_cluster(4);
    for (auto& node : cluster.nodes)
      node.flexray->pDelayCompensationA = node.flexray->pDelayCompensationB = compensated ? 100 : 0;
    Rig rig(cluster, {900'000, 300'000, -300'000, -900'000}, Duration{2500});
    rig.run_cycles(kCycles);
    EXPECT_LT(rig.precision(end), kAssumedPrecision);
    const double ppm = static_cast<double>(rig.global_time(1, end).ns - kCycles * 1'000'000) / (kCycles * 1.0);
    if (compensated) {
      EXPECT_NEAR(ppm, 0.0, 200.0);
    } else {
      EXPECT_NEAR(ppm, -1250.0, 200.0);
    }
  }
}

// One of four sync nodes sends its frames early to some and late to others: the others stay together.
TEST(Convergence, OneTwoFacedClockOfFourDoesNotTearTheOthersApart) {
  Rig rig(small_cluster(4), {1'000'000, -1'000'000, 200'000, -300'000});
  rig.run_cycles(40);
  rig.on_the_way = [](TestMedium::Arrival& frame) {
    if (frame.sender == 3) {
      const Duration lie = Duration::microseconds(frame.receiver == 0 ? 5 : -5);
      frame.start += lie;
      frame.end += lie;
    }
    return true;
  };
  Duration worst{};
  for (int quarter = 160; quarter < 1600; ++quarter) {
    const TrueTime at = Rig::kStart + Duration::microseconds(250) * quarter;
    rig.run_until(at);
    GlobalTime low = rig.global_time(0, at), high = low;
    for (const std::size_t node : {1u, 2u}) {
      low = std::min(low, rig.global_time(node, at));
      high = std::max(high, rig.global_time(node, at));
    }
    worst = std::max(worst, high - low);
  }
  EXPECT_LT(worst, kAssumedPrecision);
  for (const std::size_t node : {0u, 1u, 2u}) EXPECT_TRUE(rig.reports(node).problems.empty());
}

// Two clocks 3000 ppm apart: 3 us more per millisecond, for as long as one looks.
TEST(WithoutSynchronisation, TheDifferenceGrowsAsDriftTimesTime) {
  schedules::model::Cluster cluster = small_cluster(2);
  cluster.synchronisation = false;
  Rig rig(cluster, {1'500'000, -1'500'000});
  for (std::int64_t ms = 10; ms <= 400; ms += 10) {
    const TrueTime at = Rig::kStart + Duration::milliseconds(ms);
    rig.run_until(at);
    EXPECT_NEAR(static_cast<double>(rig.precision(at).ns), 3000.0 * static_cast<double>(ms), 60.0) << ms;
  }
  // It is still measured and reported, while frames fall into their slots.
  ASSERT_FALSE(rig.reports(0).corrected.empty());
  EXPECT_GT(rig.reports(0).corrected[0].offset.value, 0);
  EXPECT_LT(rig.reports(1).corrected[0].offset.value, 0);
  EXPECT_GT(rig.reports(0).corrected[0].rate.value, 0);
  EXPECT_EQ(rig.controller(0).clock()->rate_correction(), 0);
  // And in the end they miss each other's slots.
  EXPECT_FALSE(rig.reports(0).problems.empty());
}

}  // namespace
}  // namespace ttf::bus::controller
