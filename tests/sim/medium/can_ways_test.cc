// A private CAN's fast way and its plain way, bit by bit, are indistinguishable. Controllers without an answer send
// again.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "tests/drives/drive_fixture.h"
#include "tests/recording/record_text.h"
#include "tests/sim/medium/can_rig.h"

namespace ttf::sim::medium {
namespace {

TEST(CanWays, DrawnTrafficComesAtTheSameInstants) {
  constexpr std::array kLengths{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
  for (const bool flexible : {false, true})
    for (const double other_load : {0.0, 0.3})
      for (const std::int64_t rate : {1'000'000, 300'000}) {
        SCOPED_TRACE(fmt::format("{} {} {}", flexible, other_load, rate));
        Can fast(can_cluster(flexible, other_load, rate)), plain(can_cluster(flexible, other_load, rate));
        plain.medium.set_bit_by_bit(true);
        RandomStream draw({15, 0, Purpose::kTest, 1, 0});
        for (int step = 0; step < 800; ++step) {
          const TrueTime next = fast.time + Duration{draw.integer(1, 400'000'000'000 / rate)};
          for (Can* can : {&fast, &plain}) can->run_until(next);
          const auto node = static_cast<std::size_t>(draw.integer(0, kNodes - 1));
          const auto identifier = static_cast<std::uint32_t>(draw.integer(0, 2047));
          std::vector<std::byte> data(
              static_cast<std::size_t>(kLengths[static_cast<std::size_t>(draw.integer(0, flexible ? 15 : 8))]));
          for (std::byte& byte : data) byte = static_cast<std::byte>(draw.integer(0, 255));
          for (Can* can : {&fast, &plain}) can->send(node, identifier, data);
        }
        for (Can* can : {&fast, &plain}) can->run_until(fast.time + Duration::milliseconds(500));
        EXPECT_EQ(fast.sent, 800u);
        EXPECT_EQ(fast.diary, plain.diary);
        EXPECT_EQ(fast.medium.busy(), plain.medium.busy());
        EXPECT_TRUE(plain.errors.empty());
      }
}

// Node 2 comes and goes, when the bus is idle. A frame that comes right behind its power-on is not for it yet.
TEST(CanWays, SuppliesComeAndGo) {
  Can fast(can_cluster(false, 0.0, 1'000'000)), plain(can_cluster(false, 0.0, 1'000'000));
  plain.medium.set_bit_by_bit(true);
  const std::vector<std::byte> data(8, std::byte{0x35});
  for (Can* can : {&fast, &plain})
    for (int round = 0; round < 20; ++round) {
      can->send(0, 7, data);
      can->run_until(can->time + Duration::milliseconds(1));
      if (round % 4 == 1) can->medium.power_off(NodeId{2}, can->time);
      if (round % 4 == 3) can->medium.power_on(NodeId{2}, can->time);
      if (round % 8 == 3) can->run_until(can->time + Duration::microseconds(5));
    }
  EXPECT_EQ(fast.sent, 20u);
  EXPECT_EQ(fast.arrived, 26u);
  EXPECT_EQ(fast.diary, plain.diary);
}

// A frame of 8 bytes without another node. An attempt takes at most 98 bits to the acknowledgement, and 17 behind it.
// From the seventeenth on there are 8 more. It goes on until another node is there, which hears it once.
TEST(CanWays, AFrameIsSentAgainUntilItIsAcknowledged) {
  Can can(can_cluster(false, 0.0, 1'000'000));
  for (const int node : {1, 2}) can.medium.power_off(static_cast<NodeId>(node), can.time);
  can.send(0, 7, std::vector<std::byte>(8, std::byte{0x35}));
  can.run_until(TrueTime{20'000'000});
  EXPECT_EQ(can.sent + can.arrived, 0u);
  ASSERT_GT(can.errors.size(), 140u);
  EXPECT_LT(can.errors.size(), 170u);
  for (const auto& error : can.errors) {
    EXPECT_EQ(error.error, recording::records::kCanAcknowledgementError);
    EXPECT_TRUE(error.as_transmitter);
    EXPECT_LE(error.transmit_errors, 128);
  }
  ASSERT_EQ(can.changes.size(), 1u);
  EXPECT_EQ(can.changes[0].to, recording::records::kCanErrorPassive);
  can.medium.power_on(NodeId{1}, can.time);
  can.run_until(TrueTime{30'000'000});
  EXPECT_EQ(can.sent, 1u);
  EXPECT_EQ(can.arrived, 1u);
  EXPECT_EQ(can.changes.size(), 2u);  // error active again: 127
  // With its errors it stays on the plain way, and comes back to the fast one frame by frame.
  for (int frame = 0; frame < 130; ++frame) {
    can.send(0, 7, {});
    can.run_until(can.time + Duration::milliseconds(1));
  }
  EXPECT_EQ(can.sent, 131u);
  EXPECT_TRUE(can.queue.empty());
}

// No room is without end: four lists of one frame each, and 64 frames.
TEST(CanWays, WaitingFramesHaveRoom) {
  Can can(can_cluster(false, 0.0, 1'000'000));
  for (const int node : {1, 2}) can.medium.power_off(static_cast<NodeId>(node), can.time);
  for (int frame = 0; frame < 100; ++frame) can.send(0, 7, {});
  EXPECT_EQ(can.medium.waiting(NodeId{0}, 7), 68);
  EXPECT_EQ(can.medium.dropped(), 32u);
  can.medium.power_off(NodeId{0}, can.time);
  EXPECT_EQ(can.medium.waiting(NodeId{0}, 7), 0);
}

TEST(CanWays, AControllerOffTheBusRecoversBehindItsRelease) {
  Can can(can_cluster(false, 0.0, 1'000'000));
  can.medium.hold_off(NodeId{0}, can.time);
  ASSERT_EQ(can.changes.size(), 1u);
  EXPECT_EQ(can.changes[0].to, recording::records::kCanBusOff);
  can.send(0, 7, {});
  can.send(1, 9, {});
  can.run_until(TrueTime{10'000'000});
  EXPECT_EQ(can.sent, 1u);     // node 1's
  EXPECT_EQ(can.arrived, 1u);  // at node 2 alone
  can.medium.release(NodeId{0}, can.time);
  can.run_until(TrueTime{20'000'000});
  ASSERT_EQ(can.changes.size(), 2u);
  EXPECT_EQ(can.changes[1].to, recording::records::kCanErrorActive);
  EXPECT_EQ(can.changes[1].stamp.true_time, TrueTime{10'000'000 + 128 * 11 * 1'000});
  EXPECT_EQ(can.sent, 2u);
}

TEST(CanWays, DrivesLeaveTheSameRecords) {
  using fusion::strategies::StrategyKind;
  const std::pair<const char*, StrategyKind> cases[] = {{"scenarios/paper_scenario1.yaml", StrategyKind::kTt},
                                                        {"scenarios/paper_scenario1.yaml", StrategyKind::kAdva},
                                                        {"scenarios/faulty_can.yaml", StrategyKind::kTt},
                                                        {"scenarios/cold_start.yaml", StrategyKind::kTt}};
  for (const auto& [scenario, strategy] : cases) {
    SCOPED_TRACE(scenario);
    drives::Drive drive(scenario, strategy);
    drive.scenario.duration = std::min(drive.scenario.duration, Duration::milliseconds(2'600));
    std::vector<std::string> fast, plain;
    for (const bool bit_by_bit : {false, true}) {
      const auto sink = recording::text_into(bit_by_bit ? plain : fast);
      drives::DriveConfig config{&drive.scenario, &drive.cluster, strategy, 1, 0, nullptr, nullptr, true, bit_by_bit};
      (void)drives::run_drive(config, *sink);
    }
    ASSERT_GT(fast.size(), 1'000u);
    ASSERT_EQ(fast.size(), plain.size());
    for (std::size_t line = 0; line < fast.size(); ++line) ASSERT_EQ(fast[line], plain[line]) << line;
  }
}

}  // namespace
}  // namespace ttf::sim::medium
