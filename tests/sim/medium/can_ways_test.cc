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
#include "tests/recording/record_text.h"
#include "tests/sim/drives/drive_fixture.h"
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

// The same at drawn instants, most of them in the middle of frames: of the sender, of a receiver, of the last that could
// acknowledge.
TEST(CanWays, SuppliesComeAndGoWithinFrames) {
  for (const bool flexible : {false, true})
    for (const double other_load : {0.0, 0.3})
      for (const std::int64_t rate : {1'000'000, 300'000}) {
        SCOPED_TRACE(fmt::format("{} {} {}", flexible, other_load, rate));
        Can fast(can_cluster(flexible, other_load, rate)), plain(can_cluster(flexible, other_load, rate));
        plain.medium.set_bit_by_bit(true);
        RandomStream draw({16, 0, Purpose::kTest, 1, 0});
        const auto run = [&](TrueTime until) {
          for (Can* can : {&fast, &plain}) can->run_until(until);
        };
        for (int step = 0; step < 3'000; ++step) {
          // Now and then all are quiet, and every second step is within a frame.
          const std::int64_t bits = step % 30 == 0 ? 5'000 : step % 2 == 0 ? 80 : 400;
          run(fast.time + Duration{draw.integer(1, bits * 1'000'000'000 / rate)});
          const auto node = static_cast<NodeId>(draw.integer(0, kNodes - 1));
          const auto identifier = static_cast<std::uint32_t>(draw.integer(0, 2047));
          const std::vector<std::byte> data(static_cast<std::size_t>(draw.integer(0, 8)),
                                            static_cast<std::byte>(draw.integer(0, 255)));
          const bool changes = draw.integer(0, 3) == 0;
          for (Can* can : {&fast, &plain}) {
            if (!changes)
              can->send(index_of(node), identifier, data);
            else if (can->powered(node))
              can->power_off(node);
            else
              can->power_on(node, can->time);
          }
          ASSERT_EQ(fast.diary, plain.diary) << step;
          ASSERT_EQ(fast.medium.waiting(node, identifier, fast.time),
                    plain.medium.waiting(node, identifier, plain.time))
              << step;
          fast.diary.clear();
          plain.diary.clear();
        }
        for (Can* can : {&fast, &plain})
          for (const NodeId node : Can::kMembers) can->power_on(node, can->time);
        run(fast.time + Duration::milliseconds(500));
        EXPECT_EQ(fast.diary, plain.diary);
        EXPECT_EQ(fast.medium.busy(), plain.medium.busy());
        EXPECT_EQ(fast.medium.dropped(), plain.medium.dropped());
        // The nodes of other traffic acknowledge.
        EXPECT_GT(fast.errors.size(), other_load > 0.0 ? 10u : 50u);
        EXPECT_GT(fast.sent, 500u);
      }
}

// Other traffic: frames of 135 bits of 1 us, 450 us apart.
struct OtherTraffic {
  static constexpr std::int64_t kLength_us = 135, kPeriod_us = 450;
  std::int64_t first_ns = RandomStream({1, 0, Purpose::kOtherTraffic, 0, 0}).integer(0, kPeriod_us * 1'000 - 1);
  TrueTime begin(int frame) const { return TrueTime{first_ns + frame * kPeriod_us * 1'000}; }
  TrueTime end(int frame) const { return begin(frame) + Duration::microseconds(kLength_us); }
};

// Node 2 gets its supply shortly before a frame of other traffic, or within it. In its last ten bits that is too late.
// Node 0's frame comes right behind.
TEST(CanWays, ASupplyThatComesBesideOtherTraffic) {
  const OtherTraffic others;
  const std::pair<TrueTime, std::size_t> cases[] = {{others.begin(3) - Duration::microseconds(5), 2},
                                                    {others.begin(3), 2},
                                                    {others.begin(3) + Duration::microseconds(60), 2},
                                                    {others.end(3) - Duration::microseconds(11), 2},
                                                    {others.end(3) - Duration::microseconds(10), 1}};
  for (const auto& [at, receivers] : cases)
    for (const bool bit_by_bit : {false, true}) {
      SCOPED_TRACE(fmt::format("{} {}", at.ns, bit_by_bit));
      Can can(can_cluster(false, 0.3, 1'000'000));
      can.medium.set_bit_by_bit(bit_by_bit);
      can.medium.power_off(NodeId{2}, can.time);
      can.run_until(at);
      can.medium.power_on(NodeId{2}, can.time);
      can.run_until(others.end(3) - Duration::microseconds(3));
      can.send(0, 7, {});
      can.run_until(others.begin(4));
      EXPECT_EQ(can.arrived, receivers);
      const std::string sent = fmt::format("begun {}", others.end(3).ns);
      EXPECT_NE(can.diary.at(0).find(sent), std::string::npos) << can.diary[0] << ", not " << sent;
    }
}

// Frames on the bus, each with its intermission.
using Frames = std::vector<std::pair<TrueTime, TrueTime>>;

// Returns when a controller has recovered. Each frame ends with eleven recessive bits, and has no others.
TrueTime recovery(TrueTime from, const Frames& frames) {
  constexpr std::int64_t kSequence_ns = 11'000;
  std::int64_t sequences = 128;
  for (const auto& [begin, end] : frames) {
    if (end <= from) continue;
    if (from < begin) {
      const std::int64_t seen = std::min(sequences, (begin - from).ns / kSequence_ns);
      sequences -= seen;
      if (sequences == 0) return from + Duration{seen * kSequence_ns};
    }
    from = std::max(from, end - Duration{kSequence_ns});
  }
  return from + Duration{sequences * kSequence_ns};
}

// Between two frames of other traffic there are 315 idle bits: 28 sequences of eleven recessive ones. A frame ends with
// one more. So 128 take more than four periods, not 1408 bits.
TEST(CanWays, AControllerRecoversBetweenOtherTraffic) {
  const OtherTraffic others;
  Frames frames;
  for (int frame = 0; frame < 20; ++frame) frames.emplace_back(others.begin(frame), others.end(frame));
  for (const TrueTime at :
       {others.begin(3) - Duration::microseconds(200), others.begin(3), others.begin(3) + Duration::microseconds(60),
        others.end(3) - Duration::microseconds(4), others.end(3)})
    for (const bool bit_by_bit : {false, true}) {
      SCOPED_TRACE(fmt::format("{} {}", at.ns, bit_by_bit));
      Can can(can_cluster(false, 0.3, 1'000'000));
      can.medium.set_bit_by_bit(bit_by_bit);
      can.medium.hold_off(NodeId{0}, can.time);
      can.run_until(at);
      can.medium.release(NodeId{0}, can.time);
      can.run_until(at + Duration::milliseconds(4));
      ASSERT_EQ(can.changes.size(), 2u);
      EXPECT_EQ(can.changes[1].to, recording::records::CanState::kActive);
      EXPECT_EQ(can.changes[1].stamp.true_time, recovery(at, frames));
    }
}

// Frames of node 1 come right before and right behind a frame of other traffic. Each has its eleven bits.
TEST(CanWays, AControllerRecoversAmongFramesWithoutAPause) {
  const OtherTraffic others;
  const TrueTime at = others.begin(3) - Duration::microseconds(25);
  const Duration after_acceptance = Duration::microseconds(4);
  for (const bool bit_by_bit : {false, true}) {
    SCOPED_TRACE(bit_by_bit);
    Can can(can_cluster(false, 0.3, 1'000'000));
    can.medium.set_bit_by_bit(bit_by_bit);
    can.medium.hold_off(NodeId{0}, can.time);
    can.run_until(at);
    can.medium.release(NodeId{0}, can.time);
    can.run_until(at + Duration::microseconds(5));
    const TrueTime first = can.time;
    for (int frame = 0; frame < 2; ++frame) can.send(1, 7, {});
    can.run_until(others.begin(4));
    std::vector<TrueTime> sent;
    for (const std::string& line : can.diary)
      if (line.find("sent by 1") != std::string::npos) sent.push_back(TrueTime{std::stoll(line)} + after_acceptance);
    ASSERT_EQ(sent.size(), 2u);
    ASSERT_GT(sent[0], others.begin(3)) << "the frame of other traffic follows at once";
    const TrueTime second = sent[0] + Duration::microseconds(OtherTraffic::kLength_us);
    Frames frames{{first, sent[0]}, {sent[0], second}, {second, sent[1]}};
    for (int frame = 4; frame < 20; ++frame) frames.emplace_back(others.begin(frame), others.end(frame));
    can.run_until(at + Duration::milliseconds(4));
    ASSERT_EQ(can.changes.size(), 2u);
    EXPECT_EQ(can.changes[1].stamp.true_time, recovery(at, frames));
  }
}

// Node 0's frame 555 has bits 0, 1, 0, 1, ... It loses its supply in bit 10: from bit 9 on all are recessive, so bit 13
// is no base frame's. The frame would have lasted until bit 57.
TEST(CanWays, ASenderWithoutSupplyBreaksItsFrameOff) {
  for (const bool bit_by_bit : {false, true}) {
    Can can(can_cluster(false, 0.0, 1'000'000));
    can.medium.set_bit_by_bit(bit_by_bit);
    can.send(0, 0x555, std::vector<std::byte>(1, std::byte{0x55}));
    can.run_until(TrueTime{10'500});
    can.send(1, 7, {});
    can.medium.power_off(NodeId{0}, can.time);
    can.run_until(TrueTime{1'000'000});
    EXPECT_EQ(can.sent, 1u);     // node 1's
    EXPECT_EQ(can.arrived, 1u);  // at node 2
    ASSERT_EQ(can.errors.size(), 1u);
    EXPECT_EQ(can.errors[0].stamp.true_time, TrueTime{14'000});
    EXPECT_EQ(can.errors[0].error, recording::records::CanError::kForm);
    EXPECT_FALSE(can.errors[0].as_transmitter);
    EXPECT_EQ(can.errors[0].receive_errors, 1);
    // Behind the flags there are eight recessive bits of the delimiter and three of the intermission.
    EXPECT_NE(can.diary[1].find("begun 31000"), std::string::npos) << can.diary[1];
  }
}

// Without an answer a sender becomes error passive, and one that is held off is bus off. Both end with their supply.
TEST(CanWays, PowerOnEndsErrorStates) {
  Can can(can_cluster(false, 0.0, 1'000'000));
  for (const int node : {1, 2}) can.medium.power_off(static_cast<NodeId>(node), can.time);
  can.send(0, 7, {});
  can.run_until(TrueTime{10'000'000});
  can.medium.power_off(NodeId{0}, can.time);
  can.medium.power_on(NodeId{1}, can.time);
  can.medium.hold_off(NodeId{1}, can.time);
  can.medium.power_off(NodeId{1}, can.time);
  ASSERT_EQ(can.changes.size(), 2u);
  can.run_until(TrueTime{11'000'000});
  for (const int node : {0, 1, 2}) can.medium.power_on(static_cast<NodeId>(node), can.time);
  ASSERT_EQ(can.changes.size(), 4u);  // node 2 was error active
  for (const std::size_t node : {0u, 1u}) {
    const auto& change = can.changes[2 + node];
    EXPECT_EQ(index_of(change.stamp.node), node);
    EXPECT_EQ(change.stamp.true_time, can.time);
    EXPECT_EQ(change.from, node == 0 ? recording::records::CanState::kPassive : recording::records::CanState::kBusOff);
    EXPECT_EQ(change.to, recording::records::CanState::kActive);
    EXPECT_EQ(change.transmit_errors + change.receive_errors, 0);
  }
  can.medium.release(NodeId{1}, can.time);  // it is not held off any more
  can.send(1, 7, {});
  can.run_until(TrueTime{12'000'000});
  EXPECT_EQ(can.sent, 1u);
  EXPECT_EQ(can.arrived, 2u);
}

// A frame of 8 bytes without another node. An attempt takes at most 98 bits to the acknowledgement, and 17 behind it.
// From the seventeenth on there are 8 more. It goes on until another node is there, which receives it once.
TEST(CanWays, AFrameIsSentAgainUntilItIsAcknowledged) {
  Can can(can_cluster(false, 0.0, 1'000'000));
  for (const int node : {1, 2}) can.medium.power_off(static_cast<NodeId>(node), can.time);
  can.send(0, 7, std::vector<std::byte>(8, std::byte{0x35}));
  can.run_until(TrueTime{20'000'000});
  EXPECT_EQ(can.sent + can.arrived, 0u);
  ASSERT_GT(can.errors.size(), 140u);
  EXPECT_LT(can.errors.size(), 170u);
  for (const auto& error : can.errors) {
    EXPECT_EQ(error.error, recording::records::CanError::kAcknowledgement);
    EXPECT_TRUE(error.as_transmitter);
    EXPECT_LE(error.transmit_errors, 128);
  }
  ASSERT_EQ(can.changes.size(), 1u);
  EXPECT_EQ(can.changes[0].to, recording::records::CanState::kPassive);
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
  EXPECT_EQ(can.medium.waiting(NodeId{0}, 7, can.time), 68);
  EXPECT_EQ(can.medium.dropped(), 32u);
  can.medium.power_off(NodeId{0}, can.time);
  EXPECT_EQ(can.medium.waiting(NodeId{0}, 7, can.time), 0);
}

// Six messages of 256 frames, and all three nodes' queues full: more than 6,000 frames wait, and they all leave.
TEST(CanWays, ManyLongListsHaveRoom) {
  schedules::model::Cluster cluster = can_cluster(false, 0.0, 1'000'000);
  cluster.pdus = {bus::list_layout(4, 256 * 3, 3)};
  ASSERT_EQ(cluster.pdus[0].max_fragments(), 256);
  cluster.can_buses[0].messages.clear();
  for (std::uint32_t m = 0; m < 6; ++m)
    cluster.can_buses[0].messages.push_back(
        {PduId{0}, m, static_cast<NodeId>(m % kNodes), Duration::milliseconds(10), 0});
  Can can(cluster);
  can.writes = false;
  can.send(0, 0, {});
  can.run_until(TrueTime{20'000});  // in the middle of the first frame
  for (std::size_t node = 0; node < kNodes; ++node)
    for (int frame = 0; frame < 2'200; ++frame) can.send(node, static_cast<std::uint32_t>(node), {});
  can.medium.hold_off(NodeId{1}, can.time);  // the first frame is taken up bit by bit
  can.medium.release(NodeId{1}, can.time);
  const std::size_t room = 2 * 4 * 256 + 64;
  EXPECT_EQ(can.medium.dropped(), kNodes * (2'200 - room));
  can.run_until(TrueTime{1'000'000'000});
  EXPECT_EQ(can.sent, kNodes * room + 1);
}

TEST(CanWays, AControllerOffTheBusRecoversBehindItsRelease) {
  Can can(can_cluster(false, 0.0, 1'000'000));
  can.medium.hold_off(NodeId{0}, can.time);
  ASSERT_EQ(can.changes.size(), 1u);
  EXPECT_EQ(can.changes[0].to, recording::records::CanState::kBusOff);
  can.send(0, 7, {});
  can.send(1, 9, {});
  can.run_until(TrueTime{10'000'000});
  EXPECT_EQ(can.sent, 1u);     // node 1's
  EXPECT_EQ(can.arrived, 1u);  // at node 2 alone
  can.medium.release(NodeId{0}, can.time);
  can.run_until(TrueTime{20'000'000});
  ASSERT_EQ(can.changes.size(), 2u);
  EXPECT_EQ(can.changes[1].to, recording::records::CanState::kActive);
  EXPECT_EQ(can.changes[1].stamp.true_time, TrueTime{10'000'000 + 128 * 11 * 1'000});
  EXPECT_EQ(can.sent, 2u);
}

// Its host restarts it, without the frames that have waited.
TEST(CanWays, AControllerWhoseHostAsksRecoversThen) {
  Can can(can_cluster(false, 0.0, 1'000'000));
  can.medium.set_recovery(CanRecovery::kByHost);
  can.medium.hold_off(NodeId{0}, can.time);
  can.send(0, 7, {});
  EXPECT_FALSE(can.medium.restart(NodeId{0}, can.time)) << "it is held off";
  EXPECT_FALSE(can.medium.restart(NodeId{1}, can.time)) << "it is not bus off";
  can.medium.release(NodeId{0}, can.time);
  can.run_until(TrueTime{10'000'000});
  EXPECT_EQ(can.changes.size(), 1u);
  EXPECT_TRUE(can.medium.restart(NodeId{0}, can.time));
  EXPECT_EQ(can.medium.waiting(NodeId{0}, 7, can.time), 0);
  can.run_until(TrueTime{20'000'000});
  ASSERT_EQ(can.changes.size(), 2u);
  EXPECT_EQ(can.changes[1].stamp.true_time, TrueTime{10'000'000 + 128 * 11 * 1'000});
  can.send(0, 7, {});
  can.run_until(TrueTime{30'000'000});
  EXPECT_EQ(can.sent, 1u);
}

// A held line takes the transmitter off the bus.
TEST(CanWays, AControllerThatNeverRecoversStaysOff) {
  struct Held final : Disturbance {
    TrueTime until{};
    const Can* can = nullptr;
    bool touches_can(std::size_t, TrueTime) const override { return can->time < until; }
    TrueTime holds_can(std::size_t) const override { return until; }
  };
  for (const CanRecovery recovery : {CanRecovery::kAutomatic, CanRecovery::kByHost, CanRecovery::kNever}) {
    Can can(can_cluster(false, 0.0, 1'000'000));
    can.medium.set_recovery(recovery);
    Held held;
    held.can = &can;
    held.until = TrueTime{2'000'000};
    can.disturb(held);
    can.send(0, 7, std::vector<std::byte>(8, std::byte{0x35}));
    can.run_until(TrueTime{20'000'000});
    EXPECT_EQ(can.changes.at(0).to, recording::records::CanState::kPassive);
    const auto of_node_0 = std::count_if(can.changes.begin(), can.changes.end(), [](const auto& change) {
      return change.stamp.node == NodeId{0} && change.to == recording::records::CanState::kBusOff;
    });
    EXPECT_EQ(of_node_0, 1);
    EXPECT_EQ(can.sent, recovery == CanRecovery::kAutomatic ? 1u : 0u);
    EXPECT_EQ(can.medium.restart(NodeId{0}, can.time), recovery != CanRecovery::kAutomatic);
  }
}

TEST(CanWays, DrivesLeaveTheSameRecords) {
  using fusion::strategies::StrategyKind;
  const std::pair<const char*, StrategyKind> cases[] = {{"scenarios/paper_scenario1.yaml", StrategyKind::kTt},
                                                        {"scenarios/paper_scenario1.yaml", StrategyKind::kAdva},
                                                        {"scenarios/faulty_can.yaml", StrategyKind::kTt},
                                                        {"scenarios/cold_start.yaml", StrategyKind::kTt}};
  for (const auto& [scenario, strategy] : cases) {
    SCOPED_TRACE(scenario);
    sim::drives::Drive drive(scenario, strategy);
    drive.scenario.duration = std::min(drive.scenario.duration, Duration::milliseconds(2'600));
    std::vector<std::string> fast, plain;
    for (const bool bit_by_bit : {false, true}) {
      const auto sink = recording::text_into(bit_by_bit ? plain : fast);
      sim::drives::DriveConfig config{&drive.scenario, &drive.cluster, strategy, 1,         0,
                                      nullptr,         nullptr,        true,     bit_by_bit};
      (void)sim::drives::run_drive(config, *sink);
    }
    ASSERT_GT(fast.size(), 1'000u);
    ASSERT_EQ(fast.size(), plain.size());
    for (std::size_t line = 0; line < fast.size(); ++line) ASSERT_EQ(fast[line], plain[line]) << line;
  }
}

// Nodes crash at drawn instants and come back, most of them while the CANs are busy; meanwhile other faults act.
TEST(CanWays, DrivesWithCrashesLeaveTheSameRecords) {
  sim::drives::Drive drive("scenarios/faulty_can.yaml", fusion::strategies::StrategyKind::kTt);
  drive.scenario.duration = Duration::milliseconds(2'600);
  RandomStream draw({17, 0, Purpose::kTest, 1, 0});
  for (const char* node : {"laser_pre", "camera_pre", "gateway"})
    for (int crash = 0; crash < 4; ++crash) {
      ttf::faults::Fault fault;
      fault.kind = ttf::faults::FaultKind::kCrash;
      fault.node_name = node;
      fault.from = Duration{draw.integer(crash * 600'000'000, crash * 600'000'000 + 300'000'000)};
      fault.duration = Duration{draw.integer(1, 100'000'000)};
      drive.scenario.faults.faults.push_back(fault);
    }
  std::vector<std::string> fast, plain;
  for (const bool bit_by_bit : {false, true}) {
    const auto sink = recording::text_into(bit_by_bit ? plain : fast);
    sim::drives::DriveConfig config{&drive.scenario, &drive.cluster, drive.strategy, 1,         0,
                                    nullptr,         nullptr,        true,           bit_by_bit};
    (void)sim::drives::run_drive(config, *sink);
  }
  ASSERT_GT(fast.size(), 1'000u);
  ASSERT_EQ(fast.size(), plain.size());
  for (std::size_t line = 0; line < fast.size(); ++line) ASSERT_EQ(fast[line], plain[line]) << line;
}

}  // namespace
}  // namespace ttf::sim::medium
