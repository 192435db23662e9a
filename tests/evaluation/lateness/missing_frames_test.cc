// Why frames never came: records made by hand.
#include "evaluation/lateness/missing_frames.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "core/random.h"

namespace ttf::evaluation::lateness {
namespace {

constexpr std::int64_t kTurnNs = 5'000'000;  // a cycle
constexpr NodeId kTalker{0}, kListener{1}, kSecondTalker{2};

// Slot 1 is kTalker's in every cycle, on both channels. Slot 2 is on A only: in cycles 1, 5, 9, ...
// kTalker's, in cycles 3, 7, ... kSecondTalker's.
schedules::model::Cluster cluster_of_two_slots() {
  schedules::model::Cluster cluster;
  cluster.flexray.gMacroPerCycle = 5000;
  cluster.nodes.resize(3);
  const auto frame = [&](int slot, schedules::model::Channels channels, int base, int repetition, NodeId sender) {
    schedules::model::FrameSlot one;
    one.slot = slot;
    one.channels = channels;
    one.base_cycle = base;
    one.repetition = repetition;
    one.sender = sender;
    cluster.frames.push_back(one);
  };
  frame(1, schedules::model::Channels::kAB, 0, 1, kTalker);
  frame(2, schedules::model::Channels::kA, 1, 4, kTalker);
  frame(2, schedules::model::Channels::kA, 3, 4, kSecondTalker);
  return cluster;
}

class MissingFramesTest : public testing::Test {
 protected:
  static recording::records::TimingProblem of(NodeId node, recording::records::TimingFault what, int slot,
                                              std::int64_t cycle, std::int64_t at_cycle) {
    recording::records::TimingProblem problem;
    problem.stamp.true_time = TrueTime{at_cycle * kTurnNs + slot * 50'000};
    problem.stamp.node = node;
    problem.what = what;
    problem.cycle = cycle;
    problem.slot = static_cast<std::uint16_t>(slot);
    return problem;
  }
  // In cycle `at` of true time, which the node counts as `at + ahead`.
  void missed(std::int64_t at, std::int64_t ahead = 0, int slot = 1, NodeId sender = kTalker, int channel = 0) {
    auto problem = of(sender, recording::records::TimingFault::kSlotMissed, slot, at + ahead, at);
    problem.channel = static_cast<std::uint8_t>(channel);
    // Noticed when it was 700 us late in real time.
    problem.late = Duration::microseconds(700);
    problem.stamp.true_time += Duration{std::int64_t{700'000} * 1'000'000 / scale_ppm_};
    reported_.push_back(problem);
  }
  void lost(std::int64_t at, std::uint32_t count, std::int64_t ahead = 0, int slot = 1, int channel = 0,
            NodeId receiver = kListener) {
    auto problem = of(receiver, recording::records::TimingFault::kFramesLost, slot, at + ahead, at);
    problem.channel = static_cast<std::uint8_t>(channel);
    problem.count = count;
    reported_.push_back(problem);
  }
  // Left in cycle `at`, and is in the sender's log.
  void sent(std::int64_t at, std::int64_t ahead = 0, int slot = 1, NodeId sender = kTalker) {
    recording::records::SlotFrameSent frame;
    frame.stamp.true_time = TrueTime{at * kTurnNs + slot * 50'000 + 300'000};
    frame.stamp.node = sender;
    frame.cycle = at + ahead;
    frame.slot = static_cast<std::uint16_t>(slot);
    sent_.push_back(frame);
  }
  MissingFramesCount missing(NodeId receiver = kListener) const {
    MissingFrames frames(cluster_, scale_ppm_);
    for (const auto& problem : reported_) frames.add(problem);
    for (const auto& frame : sent_) frames.add(frame);
    const auto found = frames.by_receiver();
    return found.contains(receiver) ? found.at(receiver) : MissingFramesCount{};
  }
  std::uint64_t withheld(NodeId receiver = kListener) const { return missing(receiver).withheld; }
  std::uint64_t away(NodeId receiver = kListener) const { return missing(receiver).away; }

  schedules::model::Cluster cluster_ = cluster_of_two_slots();
  std::int64_t scale_ppm_ = 1'000'000;
  std::vector<recording::records::TimingProblem> reported_;
  std::vector<recording::records::SlotFrameSent> sent_;
};

TEST_F(MissingFramesTest, WithheldOnly) {
  missed(10);
  missed(11);
  missed(20);
  lost(12, 2);
  lost(21, 1);
  EXPECT_EQ(withheld(), 3u);
}

TEST_F(MissingFramesTest, LostOnly) {
  lost(12, 2);
  EXPECT_EQ(withheld(), 0u);
  // The missed frames are of another slot, channel or cycle, the receiver's own, or before or behind the gap.
  missed(10, 0, 2);
  missed(10, 0, 1, kTalker, 1);
  missed(9);
  missed(12);
  missed(13);
  missed(10, 0, 1, kListener);
  missed(10 + 64);
  missed(10 - 64);
  EXPECT_EQ(withheld(), 0u);
}

// Turns are those of the round: a node that counts 20 cycles ahead is at the same counter, and one 64 ahead is not.
TEST_F(MissingFramesTest, ARoundMayBeShorter) {
  cluster_.flexray.gCycleCountMax = 19;
  missed(10, 20);
  lost(11, 1);
  EXPECT_EQ(withheld(), 1u);
  reported_.clear();
  missed(49, -40, 2);
  lost(53, 2, 0, 2);  // 51 and 49
  EXPECT_EQ(withheld(), 1u);
  reported_.clear();
  missed(10, 64);
  lost(11, 1);
  EXPECT_EQ(withheld(), 0u);
}

// cycle      10  11  12  13  14
// sent        x   -   x   -   x     (- withheld)
// came        x           -   x
TEST_F(MissingFramesTest, BothInOneGap) {
  missed(11);
  missed(13);
  lost(14, 3);
  EXPECT_EQ(withheld(), 2u);
}

TEST_F(MissingFramesTest, EachReceiverAndChannelByItself) {
  missed(10, 0, 1, kTalker, 0);
  missed(10, 0, 1, kTalker, 1);
  lost(11, 1, 0, 1, 0, kListener);
  lost(11, 1, 0, 1, 1, kListener);
  lost(11, 1, 0, 1, 1, kSecondTalker);
  lost(15, 1, 0, 1, 0, kSecondTalker);
  EXPECT_EQ(withheld(kListener), 2u);
  EXPECT_EQ(withheld(kSecondTalker), 1u);
}

// Turns of a slot with gaps between its cycles, and with two senders.
TEST_F(MissingFramesTest, TurnsAreTheSchedules) {
  missed(5, 0, 2, kTalker);
  missed(7, 0, 2, kSecondTalker);
  lost(9, 2, 0, 2);  // 7 and 5
  EXPECT_EQ(withheld(), 2u);
  reported_.pop_back();
  lost(9, 1, 0, 2);  // 7
  EXPECT_EQ(withheld(), 1u);
  reported_.pop_back();
  lost(9, 1, 0, 2, 0, kSecondTalker);  // the sender in 7 misses 5
  EXPECT_EQ(withheld(kSecondTalker), 1u);
  reported_.pop_back();
  lost(13, 1, 0, 2);  // 11
  EXPECT_EQ(withheld(), 0u);
}

// A restarted node counts whole rounds less than the others, and before that, others than after.
TEST_F(MissingFramesTest, ASenderThatRestarted) {
  missed(630);
  lost(631, 1);
  missed(1000, -15 * 64);
  missed(1002, -15 * 64);
  lost(1003, 3);
  EXPECT_EQ(withheld(), 3u);
  // As would the receiver.
  lost(1003, 3, -7 * 64, 1, 0, kSecondTalker);
  EXPECT_EQ(withheld(kSecondTalker), 2u);
  // The same running cycle long before is another turn.
  reported_.clear();
  missed(40);
  lost(1001, 1, -15 * 64);  // 1000 was its cycle 40
  EXPECT_EQ(withheld(), 0u);
}

// More turns than counter values: each turn has its own instant.
TEST_F(MissingFramesTest, MoreThanARound) {
  for (std::int64_t cycle = 100; cycle < 300; ++cycle) missed(cycle);
  missed(400);
  lost(350, 200);  // 150 to 349
  EXPECT_EQ(withheld(), 150u);
  reported_.pop_back();
  lost(350, 64);  // 286 to 349
  EXPECT_EQ(withheld(), 14u);
  reported_.pop_back();
  lost(350, 65);
  EXPECT_EQ(withheld(), 15u);
  // A slot with a turn in every second cycle.
  reported_.clear();
  for (std::int64_t cycle = 1; cycle < 200; cycle += 4) missed(cycle, 0, 2);
  lost(203, 100, 0, 2);  // 201, 199, ..., 3: of each second one sender missed 5, 9, ..., 197
  EXPECT_EQ(withheld(), 49u);
}

// A stopped node acts late: true times are then far behind the turns.
TEST_F(MissingFramesTest, AStoppedProcessReportsItLater) {
  for (std::int64_t cycle = 10; cycle < 13; ++cycle) {
    missed(cycle);
    reported_.back().late += Duration{150 * kTurnNs};
    reported_.back().stamp.true_time += Duration{150 * kTurnNs};
  }
  lost(13, 3);
  reported_.back().late = Duration{99 * kTurnNs};
  reported_.back().stamp.true_time += Duration{99 * kTurnNs};
  EXPECT_EQ(withheld(), 3u);
}

// Lateness is in real time, ten times the drive's.
TEST_F(MissingFramesTest, AStretchedRun) {
  scale_ppm_ = 10'000'000;
  missed(10);
  reported_.back().late += Duration{1500 * kTurnNs};
  reported_.back().stamp.true_time += Duration{150 * kTurnNs};
  lost(11, 1);
  EXPECT_EQ(withheld(), 1u);
}

// cycle      10  11  12  13  14  15
// sent        x   x   -           x     (- withheld)
// came        x                   x
TEST_F(MissingFramesTest, ASenderThatWasAwaySentNothing) {
  sent(10);
  sent(11);
  sent(15);
  missed(12);
  lost(15, 4);
  EXPECT_EQ(withheld(), 1u);
  EXPECT_EQ(away(), 2u);  // 13 and 14; 11 was lost on the way
  // Before the first and behind the last frame the state is unknown.
  reported_.clear();
  lost(10, 3);
  lost(20, 3);
  EXPECT_EQ(away(), 0u);
}

TEST_F(MissingFramesTest, ASenderThatIsAwayWhileItRestartsCountsAnew) {
  for (std::int64_t at = 600; at < 610; ++at) sent(at);
  for (std::int64_t at = 640; at < 650; ++at) sent(at, -9 * 64);
  lost(642, 34, 3 * 64);  // 608 to 641: 608, 609, 640 and 641 were sent
  EXPECT_EQ(away(), 30u);
  // A receiver that was stopped noticed long after.
  reported_.back().stamp.true_time += Duration{200 * kTurnNs};
  reported_.back().late = Duration{200 * kTurnNs};
  EXPECT_EQ(away(), 30u);
  // It may be wrong by some cycles: the counter gives the turn.
  reported_.back().stamp.true_time += Duration{20 * kTurnNs};
  EXPECT_EQ(away(), 30u);
}

// A slot with gaps between its cycles, and with two senders, is silent only in its turns.
TEST_F(MissingFramesTest, SilenceIsOfTheSendersOwnTurns) {
  for (const std::int64_t at : {5, 9, 13}) sent(at, 0, 2, kTalker);
  for (const std::int64_t at : {3, 7, 19}) sent(at, 0, 2, kSecondTalker);
  lost(13, 3, 0, 2);  // 11, 9, 7
  EXPECT_EQ(away(), 1u);
  lost(19, 2, 0, 2);  // 17, 15
  EXPECT_EQ(away(), 2u) << "15 is kSecondTalker's; whether 17 was sent its sender's log does not say";
}

// Two reports of one frame count once, and never more frames than were lost.
TEST_F(MissingFramesTest, OneTurnCountsOnce) {
  missed(10);
  missed(10);
  missed(10, 64);
  lost(12, 2);
  EXPECT_EQ(withheld(), 1u);
}

// An oracle: drawn gaps whose frames are withheld, lost, not sent, or there. They are reported in a drawn
// order, and counted from either end.
TEST_F(MissingFramesTest, DrawnRunsAreCountedTurnByTurn) {
  for (std::uint32_t draw = 0; draw < 50; ++draw) {
    RandomStream stream({.seed = 9, .purpose = Purpose::kTest, .index = draw});
    reported_.clear();
    sent_.clear();
    const std::int64_t ahead = 64 * stream.integer(-20, 20), behind = 64 * stream.integer(-20, 20);
    std::uint64_t expected = 0, expected_away = 0, gap = 0, withheld_in_gap = 0, away_in_gap = 0;
    bool received = false;
    for (std::int64_t cycle = 0; cycle < 400; ++cycle) {
      const std::int64_t fate = stream.integer(0, 4);
      if (fate >= 2) sent(cycle, ahead);  // 2: and was lost
      if (fate >= 3) {
        if (received && gap > 0) {
          lost(cycle, static_cast<std::uint32_t>(gap), behind);
          expected += withheld_in_gap;
          expected_away += away_in_gap;
        }
        received = true;
        gap = withheld_in_gap = away_in_gap = 0;
        continue;
      }
      ++gap;
      if (fate == 0) missed(cycle, ahead);
      withheld_in_gap += fate == 0 ? 1 : 0;
      away_in_gap += fate == 1 ? 1 : 0;
    }
    for (std::size_t i = reported_.size(); i > 1; --i)
      std::swap(reported_[i - 1],
                reported_[static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(i) - 1))]);
    EXPECT_EQ(withheld(), expected) << draw;
    EXPECT_EQ(away(), expected_away) << draw;
    EXPECT_GT(std::min(expected, expected_away), 30u);
  }
}

TEST_F(MissingFramesTest, NumbersOfADamagedLogAreCounted) {
  constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t far : {-kFar - 1, std::int64_t{-1}, kFar}) {
    auto miss = of(kTalker, recording::records::TimingFault::kSlotMissed, 1, far, 0);
    auto loss = of(kListener, recording::records::TimingFault::kFramesLost, 1, ~far, 0);  // -far - 1
    loss.count = std::numeric_limits<std::uint32_t>::max();
    for (const std::int64_t late : {-kFar - 1, kFar}) {
      miss.stamp.true_time.ns = far;
      miss.late.ns = loss.late.ns = late;
      reported_.push_back(miss);
      reported_.push_back(loss);
    }
    sent(0);
    sent_.back().stamp.true_time.ns = far;
    sent_.back().cycle = ~far;
  }
  for (const std::int64_t scale : {std::int64_t{0}, std::int64_t{-5}, std::int64_t{1}, kFar}) {
    scale_ppm_ = scale;
    EXPECT_LE(withheld(), 6u * 6u);  // at most the missed ones for each loss
    EXPECT_LE(away(), 6 * std::uint64_t{std::numeric_limits<std::uint32_t>::max()});
  }
  reported_ = {of(kTalker, recording::records::TimingFault::kSlotMissed, 7, 1, 1),
               of(kListener, recording::records::TimingFault::kFramesLost, 7, 2, 2)};
  EXPECT_EQ(withheld(), 0u) << "a slot that nobody has";
  const schedules::model::Cluster nothing;
  MissingFrames frames(nothing, 1'000'000);
  for (const auto& problem : reported_) frames.add(problem);
  EXPECT_EQ(frames.by_receiver().at(kListener).withheld, 0u);
}

}  // namespace
}  // namespace ttf::evaluation::lateness
