// A private CAN's fast way and its plain way, bit by bit, are indistinguishable. Controllers without an answer send
// again.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/random.h"
#include "sim/medium/can_medium.h"
#include "tests/bus/layouts.h"
#include "tests/drives/drive_fixture.h"
#include "tests/recording/record_text.h"

namespace ttf::sim::medium {
namespace {

constexpr std::size_t kNodes = 3;

schedules::model::Cluster cluster_of(bool flexible_data_rate, double other_load, std::int64_t nominal_bit_rate) {
  schedules::model::Cluster cluster;
  cluster.nodes.resize(kNodes);
  cluster.pdus = {bus::list_layout(4, 3, 3)};
  schedules::model::CanBus bus;
  bus.name = "can";
  bus.flexible_data_rate = flexible_data_rate;
  bus.nominal_bit_rate = nominal_bit_rate;
  bus.data_bit_rate = flexible_data_rate ? 5 * nominal_bit_rate : nominal_bit_rate;
  bus.other_load = other_load;
  bus.messages = {{PduId{0}, 7, NodeId{0}, Duration::milliseconds(10), 0}};
  cluster.can_buses = {bus};
  return cluster;
}

// One CAN with its queue, and a diary of all that comes from it.
struct Can final : recording::records::Sink {
  schedules::model::Cluster cluster;
  MediumQueue queue{4096};
  FramePool pool{4096};
  CanMedium medium;
  TrueTime now{};
  std::vector<std::string> diary;
  std::vector<recording::records::CanErrorFrame> errors;
  std::vector<recording::records::CanStateChanged> changes;
  std::size_t sent = 0, arrived = 0;

  static constexpr NodeId kMembers[kNodes] = {NodeId{0}, NodeId{1}, NodeId{2}};
  explicit Can(schedules::model::Cluster c)
      : cluster(std::move(c)), medium(cluster, 0, kMembers, queue, pool, *this, 1, 0) {}
  using recording::records::Sink::on;
  void on(const recording::records::CanErrorFrame& error) override {
    errors.push_back(error);
    diary.push_back(
        fmt::format("{} error {} at {}", error.stamp.true_time.ns, error.error, index_of(error.stamp.node)));
  }
  void on(const recording::records::CanStateChanged& change) override {
    changes.push_back(change);
    diary.push_back(fmt::format("{} state {}", change.stamp.true_time.ns, change.to));
  }
  // Handles everything up to `end`.
  void run_until(TrueTime end) {
    while (!queue.empty() && queue.next().time <= end) {
      now = queue.next().time;
      const MediumEvent event = queue.pop();
      switch (event.kind) {
        case MediumEvent::Kind::kCanArbitration: medium.arbitrate(now); break;
        case MediumEvent::Kind::kCanBits: medium.end_bits(now); break;
        case MediumEvent::Kind::kCanSent:
          ++sent;
          diary.push_back(fmt::format("{} sent by {}, begun {}", now.ns, event.node, event.start.ns));
          break;
        case MediumEvent::Kind::kCanArrival: {
          ++arrived;
          std::string text = fmt::format("{} at {} from {} begun {}: {:x}", now.ns, event.node, event.sender,
                                         event.start.ns, event.identifier);
          for (const std::byte byte : pool.bytes(event.frame)) text += fmt::format(" {:02x}", static_cast<int>(byte));
          diary.push_back(text);
          pool.release(event.frame);
          break;
        }
        default: ADD_FAILURE() << "an event of another medium";
      }
    }
    now = end;
  }
  void send(std::size_t node, std::uint32_t identifier, std::span<const std::byte> data) {
    medium.send(kMembers[node], now, {identifier, cluster.can_buses[0].flexible_data_rate, data});
  }
};

TEST(CanWays, DrawnTrafficComesAtTheSameInstants) {
  constexpr std::array kLengths{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
  for (const bool flexible : {false, true})
    for (const double other_load : {0.0, 0.3})
      for (const std::int64_t rate : {1'000'000, 300'000}) {
        SCOPED_TRACE(fmt::format("{} {} {}", flexible, other_load, rate));
        Can fast(cluster_of(flexible, other_load, rate)), plain(cluster_of(flexible, other_load, rate));
        plain.medium.set_bit_by_bit(true);
        RandomStream draw({15, 0, Purpose::kTest, 1, 0});
        for (int step = 0; step < 800; ++step) {
          const TrueTime next = fast.now + Duration{draw.integer(1, 400'000'000'000 / rate)};
          for (Can* can : {&fast, &plain}) can->run_until(next);
          const auto node = static_cast<std::size_t>(draw.integer(0, kNodes - 1));
          const auto identifier = static_cast<std::uint32_t>(draw.integer(0, 2047));
          std::vector<std::byte> data(
              static_cast<std::size_t>(kLengths[static_cast<std::size_t>(draw.integer(0, flexible ? 15 : 8))]));
          for (std::byte& byte : data) byte = static_cast<std::byte>(draw.integer(0, 255));
          for (Can* can : {&fast, &plain}) can->send(node, identifier, data);
        }
        for (Can* can : {&fast, &plain}) can->run_until(fast.now + Duration::milliseconds(500));
        EXPECT_EQ(fast.sent, 800u);
        EXPECT_EQ(fast.diary, plain.diary);
        EXPECT_EQ(fast.medium.busy(), plain.medium.busy());
        EXPECT_TRUE(plain.errors.empty());
      }
}

// Node 2 comes and goes, when the bus is idle. A frame that comes right behind its power-on is not for it yet.
TEST(CanWays, SuppliesComeAndGo) {
  Can fast(cluster_of(false, 0.0, 1'000'000)), plain(cluster_of(false, 0.0, 1'000'000));
  plain.medium.set_bit_by_bit(true);
  const std::vector<std::byte> data(8, std::byte{0x35});
  for (Can* can : {&fast, &plain})
    for (int round = 0; round < 20; ++round) {
      can->send(0, 7, data);
      can->run_until(can->now + Duration::milliseconds(1));
      if (round % 4 == 1) can->medium.power_off(NodeId{2}, can->now);
      if (round % 4 == 3) can->medium.power_on(NodeId{2}, can->now);
      if (round % 8 == 3) can->run_until(can->now + Duration::microseconds(5));
    }
  EXPECT_EQ(fast.sent, 20u);
  EXPECT_EQ(fast.arrived, 26u);
  EXPECT_EQ(fast.diary, plain.diary);
}

// A frame of 8 bytes without another node. An attempt takes at most 98 bits to the acknowledgement, and 17 behind it.
// From the seventeenth on there are 8 more. It goes on until another node is there, which hears it once.
TEST(CanWays, AFrameIsSentAgainUntilItIsAcknowledged) {
  Can can(cluster_of(false, 0.0, 1'000'000));
  for (const int node : {1, 2}) can.medium.power_off(static_cast<NodeId>(node), can.now);
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
  can.medium.power_on(NodeId{1}, can.now);
  can.run_until(TrueTime{30'000'000});
  EXPECT_EQ(can.sent, 1u);
  EXPECT_EQ(can.arrived, 1u);
  EXPECT_EQ(can.changes.size(), 2u);  // error active again: 127
  // With its errors it stays on the plain way, and comes back to the fast one frame by frame.
  for (int frame = 0; frame < 130; ++frame) {
    can.send(0, 7, {});
    can.run_until(can.now + Duration::milliseconds(1));
  }
  EXPECT_EQ(can.sent, 131u);
  EXPECT_TRUE(can.queue.empty());
}

// No room is without end: four lists of one frame each, and 64 frames.
TEST(CanWays, WaitingFramesHaveRoom) {
  Can can(cluster_of(false, 0.0, 1'000'000));
  for (const int node : {1, 2}) can.medium.power_off(static_cast<NodeId>(node), can.now);
  for (int frame = 0; frame < 100; ++frame) can.send(0, 7, {});
  EXPECT_EQ(can.medium.waiting(NodeId{0}, 7), 68);
  EXPECT_EQ(can.medium.dropped(), 32u);
  can.medium.power_off(NodeId{0}, can.now);
  EXPECT_EQ(can.medium.waiting(NodeId{0}, 7), 0);
}

TEST(CanWays, AControllerOffTheBusRecoversBehindItsRelease) {
  Can can(cluster_of(false, 0.0, 1'000'000));
  can.medium.hold_off(NodeId{0}, can.now);
  ASSERT_EQ(can.changes.size(), 1u);
  EXPECT_EQ(can.changes[0].to, recording::records::kCanBusOff);
  can.send(0, 7, {});
  can.send(1, 9, {});
  can.run_until(TrueTime{10'000'000});
  EXPECT_EQ(can.sent, 1u);     // node 1's
  EXPECT_EQ(can.arrived, 1u);  // at node 2 alone
  can.medium.release(NodeId{0}, can.now);
  can.run_until(TrueTime{20'000'000});
  ASSERT_EQ(can.changes.size(), 2u);
  EXPECT_EQ(can.changes[1].to, recording::records::kCanErrorActive);
  EXPECT_EQ(can.changes[1].stamp.true_time, TrueTime{10'000'000 + 128 * 11 * 1'000});
  EXPECT_EQ(can.sent, 2u);
}

TEST(CanWays, DrivesLeaveTheSameRecords) {
  using fusion::strategies::StrategyKind;
  for (const StrategyKind strategy : {StrategyKind::kTt, StrategyKind::kAdva}) {
    drives::Drive drive("scenarios/paper_scenario1.yaml", strategy);
    drive.scenario.duration = Duration::milliseconds(1'000);
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
