// The settled frames and their instants, scripted cycle by cycle.
#include "evaluation/faults/slot_ledger.h"

#include <gtest/gtest.h>

#include "tests/sim/engine/bus_clusters.h"

namespace ttf::evaluation::faults {
namespace {

constexpr NodeId kSender{1}, kReceiver{2};

class Ledger : public testing::Test {
 protected:
  TrueTime frame_at(int cycle) const {
    return TrueTime{} + cluster_.cycle() * cycle +
           macroticks(cluster_.flexray.gdStaticSlot + cluster_.flexray.gdActionPointOffset);
  }
  TrueTime static_end(int cycle) const {
    return TrueTime{} + cluster_.cycle() * cycle +
           macroticks(cluster_.flexray.gNumberOfStaticSlots * cluster_.flexray.gdStaticSlot);
  }
  Duration macroticks(int count) const { return {count * cluster_.flexray.gdMacrotick_ps / 1000}; }

  void sends(int cycle, std::uint8_t channel) {
    recording::records::SlotFrameSent frame;
    frame.stamp = {frame_at(cycle), {}, {}, kSender};
    frame.cycle = cycle;
    frame.slot = 2;
    frame.channel = channel;
    ledger_.on(frame);
  }
  void misses(int cycle, std::uint8_t channel) {
    recording::records::SlotProblem problem;
    problem.stamp = {static_end(cycle), {}, {}, kReceiver};
    problem.cycle = cycle;
    problem.slot = 2;
    problem.channel = channel;
    problem.status = recording::records::SlotStatus::kNoFrame;
    ledger_.on(problem);
  }
  void cycle(int cycle, bool lost) {
    for (const std::uint8_t channel : {0, 1}) sends(cycle, channel);
    for (const std::uint8_t channel : {0, 1})
      if (lost) misses(cycle, channel);
  }

  schedules::model::Cluster cluster_ = sim::engine::bus_cluster(3, 3, 3);
  std::vector<SlotLoss> losses_;
  Standings standings_{cluster_, true};
  SlotLedger ledger_{cluster_, standings_, [this](const SlotLoss& loss) { losses_.push_back(loss); }};
};

TEST_F(Ledger, ALossIsSettledTwoCyclesLater) {
  cycle(0, false);
  cycle(1, true);
  cycle(2, false);
  EXPECT_TRUE(losses_.empty());
  cycle(3, false);
  ASSERT_EQ(losses_.size(), 1u);
  EXPECT_EQ(losses_[0].receiver, kReceiver);
  EXPECT_EQ(losses_[0].sender, kSender);
  EXPECT_EQ(losses_[0].slot, 2);
  EXPECT_EQ(losses_[0].cycle, 1);
  EXPECT_EQ(losses_[0].at, frame_at(1));
  EXPECT_FALSE(losses_[0].forged);
}

TEST_F(Ledger, OnOneChannelIsNoLoss) {
  cycle(0, false);
  for (const std::uint8_t channel : {0, 1}) sends(1, channel);
  misses(1, 0);
  ledger_.finish(static_end(10));
  EXPECT_TRUE(losses_.empty());
}

// The last two cycles are settled when the run is over, and once.
TEST_F(Ledger, TheLastCyclesAreSettledAtTheEnd) {
  for (int c = 0; c < 5; ++c) cycle(c, c >= 3);
  EXPECT_TRUE(losses_.empty());
  ledger_.finish(static_end(5));
  ASSERT_EQ(losses_.size(), 2u);
  EXPECT_EQ(losses_[0].cycle, 3);
  EXPECT_EQ(losses_[1].cycle, 4);
  ledger_.finish(static_end(5));
  EXPECT_EQ(losses_.size(), 2u);
}

// Over a round of the cycle counter, too.
TEST_F(Ledger, TheLastCyclesAreSettledInTheirOrderAfterARound) {
  for (int c = 60; c < 66; ++c) cycle(c, c >= 64);
  ledger_.finish(static_end(66));
  ASSERT_EQ(losses_.size(), 2u);
  EXPECT_EQ(losses_[0].at, frame_at(64));
  EXPECT_EQ(losses_[1].at, frame_at(65));
}

// A round of 50 cycles, which the pages of open cycles do not divide.
TEST_F(Ledger, ARoundMayBeShorter) {
  cluster_.flexray.gCycleCountMax = 49;
  for (int c = 0; c < 120; ++c) cycle(c, c % 25 == 24);
  ledger_.finish(static_end(120));
  ASSERT_EQ(losses_.size(), 4u);
  for (std::size_t loss = 0; loss < losses_.size(); ++loss)
    EXPECT_EQ(losses_[loss].at, frame_at(static_cast<int>(25 * loss + 24)));
}

// A node without a report has neither received nor missed the frame, and an absent frame is not forged.
TEST_F(Ledger, AFrameUnreportedByTheEndStaysOpen) {
  cycle(0, false);
  sends(1, 0);
  ledger_.finish(static_end(1));
  EXPECT_TRUE(losses_.empty());
}

// The sender's controller sent nothing on B. The receiver, without a report of that slot, got a valid frame
// there.
TEST_F(Ledger, AValidFrameThatWasNotSentIsForged) {
  cycle(0, false);
  sends(1, 0);
  ledger_.finish(static_end(2));
  ASSERT_EQ(losses_.size(), 2u) << "at both others";
  for (const SlotLoss& loss : losses_) {
    EXPECT_TRUE(loss.forged);
    EXPECT_EQ(loss.sender, kSender);
    EXPECT_EQ(loss.cycle, 1);
  }
}

}  // namespace
}  // namespace ttf::evaluation::faults
