#include "evaluation/faults/can_judge.h"

#include <gtest/gtest.h>

#include <vector>

#include "schedules/analysis/can_load.h"
#include "tests/bus/layouts.h"

namespace ttf::evaluation::faults {
namespace {

constexpr NodeId kFaulty{0}, kSender{1}, kReceiver{2};
constexpr std::uint32_t kOfFaulty = 7, kOfSender = 9;

// Three nodes on a classic CAN of 1 Mbit/s: the faulty one and another each send a message.
schedules::model::Cluster three_nodes() {
  schedules::model::Cluster cluster;
  cluster.pdus = {bus::list_layout(4, 3, 3), bus::list_layout(4, 3, 3)};
  schedules::model::CanBus bus;
  bus.name = "can";
  bus.nominal_bit_rate = bus.data_bit_rate = 1'000'000;
  bus.messages = {{PduId{0}, kOfFaulty, kFaulty, Duration::milliseconds(10), 0},
                  {PduId{1}, kOfSender, kSender, Duration::milliseconds(10), 0}};
  cluster.can_buses = {bus};
  for (int n = 0; n < 3; ++n) {
    schedules::model::Node node;
    schedules::model::Task task;
    task.reads.push_back({"list", PduId{0}, schedules::model::MediumId::can(0), 0});
    node.tasks.push_back(task);
    cluster.nodes.push_back(node);
  }
  return cluster;
}

class Judged : public testing::Test {
 protected:
  static TrueTime at_us(std::int64_t us) { return TrueTime{us * 1'000}; }
  void queue(std::uint8_t content, std::int64_t us) {
    const std::vector<std::byte> data{std::byte{content}};
    judge_.queued(kSender, kOfSender, data, at_us(us));
  }
  void receive(std::uint8_t content, std::int64_t us, NodeId receiver = kReceiver) {
    const std::vector<std::byte> data{std::byte{content}};
    judge_.received(receiver, kOfSender, data, false, false, at_us(us));
  }
  void attempt(NodeId sender, std::uint32_t identifier, std::int64_t us) {
    recording::records::CanFrameSent frame;
    frame.start.true_time = at_us(us);
    frame.start.node = sender;
    frame.identifier = identifier;
    judge_.begun(frame);
  }
  void error(NodeId node, std::int64_t us, recording::records::CanError kind = recording::records::CanError::kBit) {
    recording::records::CanErrorFrame error;
    error.stamp.true_time = at_us(us);
    error.stamp.node = node;
    error.error = kind;
    error.as_transmitter = true;
    judge_.error_frame(error);
  }
  void state(NodeId node, recording::records::CanState to, std::int64_t us) {
    recording::records::CanStateChanged change;
    change.stamp.true_time = at_us(us);
    change.stamp.node = node;
    change.to = to;
    judge_.state_changed(change);
  }
  bool harmed(CanHarm harm, std::int64_t end_us = 100'000) {
    return judge_.finish(at_us(end_us)).harms[static_cast<std::size_t>(harm)].has_value();
  }
  bool unharmed(std::int64_t end_us = 100'000) {
    for (const CanHarm harm : kAllCanHarms)
      if (harmed(harm, end_us)) return false;
    return true;
  }

  const schedules::model::Cluster cluster_ = three_nodes();
  const std::int64_t bound_us_ =
      schedules::analysis::can_worst_response(cluster_, cluster_.can_buses[0], cluster_.can_buses[0].messages[1])
          .value()
          .ns /
      1'000;
  const std::int64_t longest_us_ =
      schedules::analysis::can_worst_case(cluster_.can_buses[0], cluster_.pdus[0].fragment_bytes).ns / 1'000;
  CanJudge judge_{cluster_, {0, kFaulty, at_us(1'000), at_us(50'000)}};
};

TEST_F(Judged, AFrameInTimeIsNoHarm) {
  queue(1, 2'000);
  receive(1, 2'000 + bound_us_);
  EXPECT_TRUE(unharmed());
}

TEST_F(Judged, AFrameBehindTheBoundIsLate) {
  queue(1, 2'000);
  receive(1, 2'001 + bound_us_);
  EXPECT_TRUE(harmed(CanHarm::kFrameLate));
  EXPECT_FALSE(harmed(CanHarm::kFrameLost));
}

// An error frame while it waits, and one before.
TEST_F(Judged, AnErrorFrameMovesTheBoundByTheLongestFrameAndItsEnd) {
  error(kFaulty, 1'900);
  queue(1, 2'000);
  error(kFaulty, 2'100);
  receive(1, 2'000 + bound_us_ + longest_us_ + 31);
  EXPECT_TRUE(unharmed());
  queue(2, 20'000);
  error(kFaulty, 20'100);
  receive(2, 20'001 + bound_us_ + longest_us_ + 31);
  EXPECT_TRUE(harmed(CanHarm::kFrameLate));
}

TEST_F(Judged, NoMoreErrorFramesCountThanAConfinedNodeMakes) {
  queue(1, 2'000);
  for (int i = 0; i < 40; ++i) error(kSender, 2'001 + i);
  receive(1, 2'001 + bound_us_ + 32 * (longest_us_ + 31));
  EXPECT_TRUE(harmed(CanHarm::kFrameLate));
}

TEST_F(Judged, AFrameThatALaterOneOvertakesIsLost) {
  queue(1, 2'000);
  queue(2, 2'000);
  receive(2, 2'100);
  const auto& harms = judge_.finish(at_us(2'200)).harms;
  const auto& lost = harms[static_cast<std::size_t>(CanHarm::kFrameLost)];
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->first, at_us(2'100));
  EXPECT_EQ(lost->node, kReceiver);
  EXPECT_EQ(lost->sender, kSender);
  EXPECT_EQ(lost->frame_id, static_cast<int>(kOfSender));
}

TEST_F(Judged, AFrameThatNeverComesIsLostOnceItIsOverdue) {
  queue(1, 2'000);
  EXPECT_TRUE(unharmed(2'000 + bound_us_));
  EXPECT_TRUE(harmed(CanHarm::kFrameLost, 2'001 + bound_us_));
}

TEST_F(Judged, AFrameTwiceAndAnUnknownOneAreHarm) {
  queue(1, 2'000);
  receive(1, 2'100);
  receive(1, 2'200);
  EXPECT_TRUE(harmed(CanHarm::kFrameTwice));
  EXPECT_FALSE(harmed(CanHarm::kFrameWrong));
  receive(9, 2'300);
  EXPECT_TRUE(harmed(CanHarm::kFrameWrong));
}

// Neither frames at the faulty node nor the time before the fault are harm.
TEST_F(Judged, TheFaultyNodeAndTheTimeBeforeDoNotCount) {
  queue(1, 100);
  ASSERT_LT(100 + bound_us_, 999);
  receive(1, 999);
  receive(9, 2'000, kFaulty);
  const auto& harms = judge_.finish(at_us(3'000)).harms;
  EXPECT_FALSE(harms[static_cast<std::size_t>(CanHarm::kFrameLate)]);
  EXPECT_FALSE(harms[static_cast<std::size_t>(CanHarm::kFrameWrong)]);
}

// 32 failures in a row are what confinement allows, and any number without an acknowledgement.
TEST_F(Judged, ANodeThatFailsForeverIsUncontained) {
  for (int i = 0; i < 100; ++i) {
    attempt(kFaulty, kOfFaulty, 2'000 + 10 * i);
    error(kFaulty, 2'005 + 10 * i, recording::records::CanError::kAcknowledgement);
  }
  for (int i = 0; i < 32; ++i) {
    attempt(kFaulty, kOfFaulty, 4'000 + 10 * i);
    error(kFaulty, 4'005 + 10 * i);
  }
  EXPECT_FALSE(harmed(CanHarm::kUncontained));
  attempt(kSender, kOfSender, 5'000);
  error(kSender, 5'005);  // of another's frame
  EXPECT_FALSE(harmed(CanHarm::kUncontained));
  attempt(kSender, kOfSender, 6'000);
  attempt(kFaulty, kOfFaulty, 6'000);  // it wins the arbitration
  error(kFaulty, 6'005);
  EXPECT_TRUE(harmed(CanHarm::kUncontained));
}

TEST_F(Judged, SuccessAndBusOffEndARowOfFailures) {
  for (int round = 0; round < 4; ++round) {
    for (int i = 0; i < 30; ++i) {
      attempt(kFaulty, kOfFaulty, 2'000 + 1'000 * round + 10 * i);
      error(kFaulty, 2'005 + 1'000 * round + 10 * i);
    }
    if (round % 2 == 0)
      judge_.sent(kFaulty);
    else
      state(kFaulty, recording::records::CanState::kBusOff, 2'900 + 1'000 * round);
  }
  EXPECT_FALSE(harmed(CanHarm::kUncontained));
}

TEST_F(Judged, StatesAndTheirEnds) {
  state(kReceiver, recording::records::CanState::kPassive, 2'000);
  state(kFaulty, recording::records::CanState::kBusOff, 3'000);
  state(kReceiver, recording::records::CanState::kActive, 6'000);
  const CanJudgement& judgement = judge_.finish(at_us(90'000));
  EXPECT_EQ(judgement.seen_by_others[static_cast<std::size_t>(CanCheck::kPassive)], at_us(2'000));
  EXPECT_EQ(judgement.seen_by_itself[static_cast<std::size_t>(CanCheck::kBusOff)], at_us(3'000));
  EXPECT_EQ(judgement.passive, at_us(2'000));
  EXPECT_EQ(judgement.halt, at_us(3'000));
  EXPECT_EQ(judgement.reintegration, Duration::milliseconds(4));
  EXPECT_EQ(judgement.still_out, 1);
  EXPECT_EQ(judgement.detected(), at_us(2'000));
}

}  // namespace
}  // namespace ttf::evaluation::faults
