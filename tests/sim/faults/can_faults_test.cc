// Faults on a private CAN, and the controllers that see them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/faults/injector.h"
#include "tests/sim/medium/can_rig.h"
#include "tests/support/allocation_counter.h"

namespace ttf::sim::faults {
namespace {

using recording::records::CanState;
using recording::records::CanStateChanged;
using testing::ElementsAre;
using testing::HasSubstr;
using ttf::faults::FaultKind;

// A classic CAN of 1 Mbit/s with nodes 0, 1 and 2, and one fault. Node 0 sends a frame with one byte 55 every
// millisecond, from 0.5 ms on: 57 bits.
struct FaultyCan {
  medium::Can can{named(medium::can_cluster(false, 0.0, 1'000'000))};
  Injector injector;

  static schedules::model::Cluster named(schedules::model::Cluster cluster) {
    for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
      cluster.nodes[n].name = std::string(1, static_cast<char>('a' + n));
    return cluster;
  }
  explicit FaultyCan(const ttf::faults::Fault& fault) : injector({"", {fault}}, can.cluster, can, 1, 0, can) {
    can.disturb(injector);
  }
  FaultyCan& run(int milliseconds) {
    const std::vector<std::byte> data{std::byte{0x55}};
    for (int ms = 0; ms < milliseconds; ++ms) {
      can.run_until(can.time + Duration::microseconds(500));
      can.send(0, 0x555, data);
      can.run_until(can.time + Duration::microseconds(500));
    }
    return *this;
  }
  std::uint64_t acts() const { return injector.activations()[0].times; }
  std::vector<CanState> states_of(int node) const {
    std::vector<CanState> states;
    for (const CanStateChanged& change : can.changes)
      if (index_of(change.stamp.node) == static_cast<std::size_t>(node)) states.push_back(change.to);
    return states;
  }
};

ttf::faults::Fault fault_at(FaultKind kind, int node, int from_ms, int duration_ms) {
  ttf::faults::Fault fault;
  fault.kind = kind;
  fault.node = static_cast<NodeId>(node);
  fault.can = 0;
  fault.from = Duration::milliseconds(from_ms);
  fault.duration = Duration::milliseconds(duration_ms);
  return fault;
}

TEST(CanFaults, OmissionLosesFramesAtTheHostAndNoBitOfTheBus) {
  ttf::faults::Fault fault = fault_at(FaultKind::kCanOmission, 0, 2, 4);
  fault.every = 2;
  FaultyCan sending(fault);
  sending.run(10);
  EXPECT_EQ(sending.can.sent, 8u);
  EXPECT_EQ(sending.can.arrived, 16u);
  EXPECT_EQ(sending.acts(), 2u);
  fault = fault_at(FaultKind::kCanOmission, 1, 2, 4);
  fault.direction = ttf::faults::FaultDirection::kReceive;
  FaultyCan receiving(fault);
  receiving.run(10);
  EXPECT_EQ(receiving.can.sent, 10u);
  EXPECT_EQ(receiving.can.arrived, 16u);
  EXPECT_EQ(receiving.acts(), 4u);
  EXPECT_TRUE(sending.can.errors.empty() && receiving.can.errors.empty());
}

// Bit 25 is in the data (tests/bus/can/line_test.cc): error flags 26..35, the delimiter and the intermission end with
// bit 46. The second attempt begins 47 us after the first, and is corrupted again; the third is not.
TEST(CanFaults, ACorruptedFrameIsSentAgain) {
  ttf::faults::Fault fault = fault_at(FaultKind::kCanCorruption, 0, 0, 10);
  fault.bit = 25;
  fault.duration = Duration::microseconds(560);
  FaultyCan faulty(fault);
  faulty.run(2);
  ASSERT_EQ(faulty.can.errors.size(), 2u);
  EXPECT_EQ(faulty.can.errors[0].stamp.true_time, TrueTime{526'000});
  EXPECT_EQ(faulty.can.errors[0].error, recording::records::CanError::kBit);
  EXPECT_EQ(faulty.can.errors[0].transmit_errors, 8);
  EXPECT_EQ(faulty.can.errors[1].stamp.true_time, TrueTime{526'000 + 47'000});
  EXPECT_EQ(faulty.can.errors[1].transmit_errors, 16);
  EXPECT_EQ(faulty.can.sent, 2u);
  EXPECT_EQ(faulty.can.arrived, 4u);
  EXPECT_THAT(faulty.can.diary[2], HasSubstr(std::to_string(500'000 + 2 * 47'000 + 53'000) + " "));
  EXPECT_THAT(faulty.can.faults[1], HasSubstr("bit 25 of a frame of a on can is inverted"));
}

TEST(CanFaults, AnErrorOfOneReceiverIsOneOfAll) {
  ttf::faults::Fault fault = fault_at(FaultKind::kCanCorruption, 0, 0, 1);
  fault.bit = 25;
  fault.receivers = {NodeId{1}};
  fault.duration = Duration::microseconds(520);
  FaultyCan faulty(fault);
  faulty.run(1);
  ASSERT_EQ(faulty.can.errors.size(), 1u);
  EXPECT_EQ(faulty.can.errors[0].stamp.node, NodeId{1});
  EXPECT_EQ(faulty.can.errors[0].error, recording::records::CanError::kCrc);
  EXPECT_EQ(faulty.can.arrived, 2u);
}

// A bit drawn anywhere in the frame: each attempt fails, and 32 of them take the node off the bus. The others receive
// nothing of it any more, until it has recovered.
TEST(CanFaults, CorruptionTakesTheSenderOffTheBus) {
  FaultyCan faulty(fault_at(FaultKind::kCanCorruption, 0, 2, 8));
  faulty.run(20);
  EXPECT_GE(faulty.acts(), 32u);
  EXPECT_THAT(faulty.states_of(0), testing::Contains(CanState::kBusOff));
  EXPECT_NE(faulty.states_of(0).back(), CanState::kBusOff);
  // Its frames wait, and all arrive. Some may come twice, after an error in the last bit.
  EXPECT_GE(faulty.can.sent, 20u);
  EXPECT_GE(faulty.can.arrived, 40u);
}

TEST(CanFaults, ABabblingNodeFillsTheBus) {
  ttf::faults::Fault fault = fault_at(FaultKind::kCanBabbling, 2, 2, 4);
  fault.interval = Duration{};
  FaultyCan faulty(fault);
  faulty.run(2);
  const std::size_t before = faulty.can.sent;
  faulty.run(4);
  const std::size_t babble = faulty.can.sent - before;
  EXPECT_GT(babble, 30u);  // 4 ms of frames with 8 bytes, 111 bits at least
  EXPECT_EQ(faulty.can.medium.waiting(NodeId{0}, 0x555, faulty.can.time), 4);  // those of higher identifiers wait
  faulty.run(4);
  EXPECT_EQ(faulty.can.medium.waiting(NodeId{0}, 0x555, faulty.can.time), 0);
  EXPECT_TRUE(faulty.can.errors.empty());
}

TEST(CanFaults, BusOffLastsAndEndsByRecovery) {
  FaultyCan faulty(fault_at(FaultKind::kCanBusOff, 0, 2, 4));
  faulty.run(6);
  EXPECT_EQ(faulty.can.sent, 2u);
  EXPECT_THAT(faulty.states_of(0), ElementsAre(CanState::kBusOff));
  faulty.run(4);
  // The bus is silent: it recovers 128 * 11 bits later.
  EXPECT_THAT(faulty.states_of(0), ElementsAre(CanState::kBusOff, CanState::kActive));
  EXPECT_EQ(faulty.can.changes[1].stamp.true_time, TrueTime{6'000'000 + 128 * 11 * 1'000});
  EXPECT_EQ(faulty.can.sent, 10u);
  EXPECT_EQ(faulty.acts(), 2u);
}

// Frames of others are on the bus when it is taken off and released. The end of the present frame counts for it, on
// the fast way, too.
TEST(CanFaults, BusOffBeginsAndEndsInTheMiddleOfFrames) {
  std::vector<std::vector<std::string>> diaries;
  for (const bool bit_by_bit : {false, true}) {
    diaries.emplace_back();
    for (int offset = 0; offset < 80; offset += 3) {
      ttf::faults::Fault fault = fault_at(FaultKind::kCanBusOff, 1, 0, 0);
      fault.from = Duration::microseconds(1480 + offset);
      fault.duration = Duration::microseconds(2000 + offset % 7);
      FaultyCan faulty(fault);
      faulty.can.medium.set_bit_by_bit(bit_by_bit);
      faulty.run(8);
      EXPECT_EQ(faulty.can.sent, 8u);
      EXPECT_THAT(faulty.states_of(1), ElementsAre(CanState::kBusOff, CanState::kActive));
      diaries.back().insert(diaries.back().end(), faulty.can.diary.begin(), faulty.can.diary.end());
    }
  }
  EXPECT_EQ(diaries[0], diaries[1]);
}

TEST(CanFaults, AStuckLineSilencesAllAndLetsGo) {
  FaultyCan faulty(fault_at(FaultKind::kCanStuckDominant, 2, 2, 4));
  faulty.run(6);
  EXPECT_EQ(faulty.can.sent, 2u);
  for (const int node : {0, 1, 2}) EXPECT_THAT(faulty.states_of(node), ElementsAre(CanState::kPassive)) << node;
  ASSERT_FALSE(faulty.can.errors.empty());
  EXPECT_EQ(faulty.can.errors[0].error, recording::records::CanError::kStuff);
  EXPECT_EQ(faulty.can.errors[0].stamp.true_time, TrueTime{2'006'000});
  faulty.run(6);
  EXPECT_EQ(faulty.can.sent, 12u);
  EXPECT_EQ(faulty.states_of(1).back(), CanState::kActive);
}

// To the end, and for an hour: time passes in eights of bits.
TEST(CanFaults, AStuckLineCostsNoTime) {
  ttf::faults::Fault fault = fault_at(FaultKind::kCanStuckDominant, 2, 2, 3'600'000);
  FaultyCan hour(fault);
  hour.run(4);
  hour.can.run_until(TrueTime{} + Duration::milliseconds(3'600'001));
  EXPECT_LT(hour.can.errors.size(), 10u);
  hour.can.run_until(TrueTime{} + Duration::milliseconds(3'600'010));
  EXPECT_EQ(hour.can.sent, 4u);
  fault.duration = ttf::faults::Fault::kToTheEnd;
  FaultyCan forever(fault);
  forever.run(4);
  EXPECT_TRUE(forever.can.queue.empty());
}

TEST(CanFaults, ANodeThatDoesNotAcknowledgeMattersWhereNoOtherDoes) {
  FaultyCan three(fault_at(FaultKind::kCanNoAcknowledgement, 1, 2, 4));
  three.run(10);
  EXPECT_TRUE(three.can.errors.empty());
  EXPECT_EQ(three.can.arrived, 20u);
  FaultyCan two(fault_at(FaultKind::kCanNoAcknowledgement, 1, 2, 4));
  two.can.power_off(NodeId{2});
  two.run(6);
  EXPECT_EQ(two.can.sent, 2u);
  EXPECT_GT(two.can.errors.size(), 20u);
  for (const auto& error : two.can.errors) EXPECT_EQ(error.error, recording::records::CanError::kAcknowledgement);
  EXPECT_THAT(two.states_of(0), ElementsAre(CanState::kPassive));  // never bus off
  two.run(4);
  EXPECT_EQ(two.can.sent, 10u);
}

// While a fault may act, an idle bus is not looked at; a supply that comes back then is.
TEST(CanFaults, SuppliesComeAndGoMeanwhile) {
  for (const FaultKind kind :
       {FaultKind::kCanCorruption, FaultKind::kCanNoAcknowledgement, FaultKind::kCanStuckDominant}) {
    ttf::faults::Fault fault = fault_at(kind, 0, 1, 10);
    fault.probability = kind == FaultKind::kCanCorruption ? 0.0 : 1.0;
    if (kind == FaultKind::kCanStuckDominant) fault.duration = ttf::faults::Fault::kToTheEnd;
    FaultyCan faulty(fault);
    faulty.run(3);
    faulty.can.power_off(NodeId{1});
    faulty.run(2);
    faulty.can.power_on(NodeId{1}, faulty.can.time);
    faulty.run(2);
    faulty.can.medium.hold_off(NodeId{2}, faulty.can.time);
    faulty.run(2);
    faulty.can.medium.release(NodeId{2}, faulty.can.time);
    faulty.run(3);
    if (kind == FaultKind::kCanStuckDominant) {
      faulty.can.power_off(NodeId{0});  // the driver lets go
      faulty.run(1);
      EXPECT_EQ(faulty.states_of(1).back(), CanState::kActive) << "since its power-on";
      continue;
    }
    EXPECT_EQ(faulty.can.sent, 12u);
    EXPECT_EQ(faulty.can.medium.waiting(NodeId{0}, 0x555, faulty.can.time), 0);
  }
}

TEST(CanFaults, AllocateNothing) {
  FaultyCan faulty(fault_at(FaultKind::kCanCorruption, 0, 2, 20));
  faulty.can.writes = false;
  faulty.run(2);
  const std::vector<std::byte> data(8, std::byte{0x55});
  const std::int64_t before = support::allocations();
  for (int ms = 0; ms < 30; ++ms) {
    faulty.can.send(ms % 2 == 0 ? 0 : 1, 0x100, data);
    faulty.can.run_until(faulty.can.time + Duration::milliseconds(1));
  }
  EXPECT_EQ(support::allocations(), before);
  EXPECT_GE(faulty.acts(), 10u);
}

TEST(CanFaults, AFunctionOfTheirSeed) {
  std::vector<std::string> diaries[2];
  for (auto& diary : diaries) {
    ttf::faults::Fault fault = fault_at(FaultKind::kCanCorruption, 0, 2, 6);
    fault.probability = 0.5;
    FaultyCan faulty(fault);
    faulty.run(12);
    diary = faulty.can.diary;
    diary.insert(diary.end(), faulty.can.faults.begin(), faulty.can.faults.end());
  }
  EXPECT_EQ(diaries[0], diaries[1]);
}

}  // namespace
}  // namespace ttf::sim::faults
