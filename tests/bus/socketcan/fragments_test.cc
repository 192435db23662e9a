// Fragments out of order, duplicated, missing, or interleaved with others.
#include <gtest/gtest.h>

#include <vector>

#include "bus/socketcan/flexray_on_can.h"
#include "core/random.h"
#include "tests/bus/socketcan/frames.h"

namespace ttf::bus::socketcan {
namespace {

using schedules::model::Channel;

class Fragments : public ::testing::Test {
 protected:
  static constexpr int kSlot = 70, kCycle = 21, kWords = 90;  // 188 bytes
  const Bytes frame_ = drawn_frame(Channel::kA, kSlot, kCycle, kWords);
  const CanFrames can_ = frame_to_can(kSlot, frame_);
  Reassembly receiver_{Channel::kA};

  Outcome arrive(std::size_t fragment) { return receiver_.arrive(can_.frames[fragment]).outcome; }
  void expect_whole() {
    for (std::size_t i = 0; i + 1 < can_.count; ++i) ASSERT_EQ(arrive(i), Outcome::kFragment) << i;
    const Arrival last = receiver_.arrive(can_.frames[can_.count - 1]);
    ASSERT_EQ(last.outcome, Outcome::kComplete);
    EXPECT_EQ(bytes_of(last.frame), frame_);
  }
};

TEST_F(Fragments, AreFour) { ASSERT_EQ(can_.count, 4u); }

// 0 1 . 3 | 0 1 2 3
TEST_F(Fragments, OneThatIsMissingCostsTheFrame) {
  arrive(0), arrive(1);
  const Arrival arrival = receiver_.arrive(can_.frames[3]);
  EXPECT_EQ(arrival.outcome, Outcome::kDisplaced);
  EXPECT_TRUE(arrival.abandoned);
  EXPECT_EQ(arrival.slot, kSlot);
  expect_whole();
  EXPECT_EQ(receiver_.abandoned(), 1u);
}

// . 1 2 3: without a begun frame, no frame is abandoned.
TEST_F(Fragments, WithoutTheFirstAreDisplaced) {
  for (std::size_t i = 1; i < can_.count; ++i) EXPECT_EQ(arrive(i), Outcome::kDisplaced) << i;
  EXPECT_EQ(receiver_.abandoned(), 0u);
  expect_whole();
}

// 0 0 1 0 1 2 2 3 3
TEST_F(Fragments, ThatComeTwiceDoNoHarm) {
  EXPECT_EQ(arrive(0), Outcome::kFragment);
  EXPECT_EQ(arrive(0), Outcome::kDisplaced);
  EXPECT_EQ(arrive(1), Outcome::kFragment);
  EXPECT_EQ(arrive(0), Outcome::kDisplaced);
  EXPECT_EQ(arrive(1), Outcome::kDisplaced);
  EXPECT_EQ(arrive(2), Outcome::kFragment);
  EXPECT_EQ(arrive(2), Outcome::kDisplaced);
  EXPECT_EQ(arrive(3), Outcome::kComplete);
  EXPECT_EQ(arrive(3), Outcome::kDisplaced);
  EXPECT_EQ(receiver_.abandoned(), 0u);
}

// Two senders in one slot: the same place, other bytes.
TEST_F(Fragments, OfAnotherSenderInTheSamePlaceEndTheFrame) {
  arrive(0), arrive(1);
  canfd_frame other = can_.frames[1];
  other.data[10] ^= 1;
  const Arrival arrival = receiver_.arrive(other);
  EXPECT_EQ(arrival.outcome, Outcome::kDisplaced);
  EXPECT_TRUE(arrival.abandoned);
  EXPECT_EQ(arrive(2), Outcome::kDisplaced);
  expect_whole();
}

TEST_F(Fragments, OfTheNextCycleDoNotContinueThisOne) {
  const CanFrames next = frame_to_can(kSlot, drawn_frame(Channel::kA, kSlot, kCycle + 1, kWords));
  arrive(0);
  EXPECT_EQ(receiver_.arrive(next.frames[1]).outcome, Outcome::kDisplaced);
  EXPECT_EQ(arrive(1), Outcome::kDisplaced);
  EXPECT_EQ(receiver_.abandoned(), 1u);
}

TEST_F(Fragments, ThatBeginAnewEndWhatWasBegun) {
  const Bytes second = drawn_frame(Channel::kA, 71, kCycle, 40);
  const CanFrames next = frame_to_can(71, second);
  arrive(0);
  const Arrival first = receiver_.arrive(next.frames[0]);
  EXPECT_EQ(first.outcome, Outcome::kFragment);
  EXPECT_TRUE(first.abandoned);
  const Arrival last = receiver_.arrive(next.frames[1]);
  ASSERT_EQ(last.outcome, Outcome::kComplete);
  EXPECT_EQ(bytes_of(last.frame), second);
  EXPECT_EQ(arrive(1), Outcome::kDisplaced);
}

TEST_F(Fragments, EndWithAWholeFrameASymbolOrABrokenFrameInBetween) {
  Bytes broken = drawn_frame(Channel::kA, 71, kCycle, 4);
  broken[2] ^= std::byte{1};
  for (const canfd_frame& between :
       {frame_to_can(71, drawn_frame(Channel::kA, 71, kCycle, 4)).frames[0], frame_to_can(71, broken).frames[0],
        symbol_to_can(Channel::kA, ports::Signal::kCas, Duration::nanoseconds(5'700))}) {
    arrive(0);
    const Arrival arrival = receiver_.arrive(between);
    EXPECT_EQ(arrival.outcome, Outcome::kComplete);
    EXPECT_TRUE(arrival.abandoned);
    EXPECT_EQ(arrive(1), Outcome::kDisplaced);
  }
  EXPECT_EQ(receiver_.abandoned(), 3u);
  expect_whole();
}

TEST_F(Fragments, GoOnOverWhatIsMalformed) {
  for (std::size_t i = 0; i < can_.count; ++i) {
    canfd_frame malformed = can_.frames[i];
    malformed.data[0] |= 0x40;
    EXPECT_EQ(receiver_.arrive(malformed).outcome, Outcome::kMalformed);
    EXPECT_EQ(arrive(i), i + 1 < can_.count ? Outcome::kFragment : Outcome::kComplete);
  }
  EXPECT_EQ(receiver_.abandoned(), 0u);
}

// It comes from another node at any time, outside the slots. One with a wrong CRC changes nothing either.
TEST_F(Fragments, GoOnOverAFollowUp) {
  const canfd_frame follow_up = follow_up_to_can(Channel::kA, {.slot = 3, .cycle_counter = kCycle, .late = {1'000}});
  canfd_frame broken = follow_up;
  broken.data[9] ^= 1;
  for (std::size_t i = 0; i < can_.count; ++i) {
    const Arrival arrival = receiver_.arrive(follow_up);
    EXPECT_EQ(arrival.outcome, Outcome::kComplete);
    EXPECT_FALSE(arrival.abandoned);
    EXPECT_EQ(receiver_.arrive(broken).outcome, Outcome::kMalformed);
    EXPECT_EQ(arrive(i), i + 1 < can_.count ? Outcome::kFragment : Outcome::kComplete);
  }
  EXPECT_EQ(receiver_.abandoned(), 0u);
}

// One form only: a frame that fits one CAN FD frame is not accepted in one or two fragments.
TEST_F(Fragments, AreNotForFramesThatGoWhole) {
  for (const int words : {4, 28}) {
    const Bytes frame = drawn_frame(Channel::kA, kSlot, kCycle, words);
    const std::size_t here = std::min(frame.size(), kFragmentBytes);
    canfd_frame one{};
    one.can_id = kSlot;
    one.flags = CANFD_FDF;
    one.len = static_cast<std::uint8_t>(can_fd_length(kFragmentHeaderBytes + here));
    one.data[0] = words == 4 ? 0x80 : 0x88;
    one.data[1] = kCycle;
    one.data[2] = static_cast<std::uint8_t>(frame.size());
    for (std::size_t i = 0; i < here; ++i) one.data[3 + i] = static_cast<std::uint8_t>(frame[i]);
    EXPECT_EQ(receiver_.arrive(one).outcome, Outcome::kMalformed) << words;
  }
}

// Drawn sequences of two frames' fragments, some lost, duplicated or swapped. Laws: a complete frame is one
// of the sent frames. Every frame whose fragments came in order without interruption is complete.
TEST_F(Fragments, InAnyOrderMakeNoOtherFrame) {
  RandomStream draw({.seed = 3});
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(draw.integer(0, static_cast<std::int64_t>(n) - 1));
  };
  std::uint64_t complete = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::vector<Bytes> frames;
    std::vector<CanFrames> sent;
    for (int k = 0; k < 2; ++k) {
      const int slot = 70 + static_cast<int>(below(2)), words = 29 + static_cast<int>(below(99));
      frames.push_back(drawn_frame(Channel::kA, slot, static_cast<int>(below(2)), words));
      sent.push_back(frame_to_can(slot, frames.back()));
    }
    std::vector<canfd_frame> line;
    for (const CanFrames& one : sent)
      for (const canfd_frame& part : one.all())
        if (below(8) != 0) line.insert(line.end(), 1 + (below(8) == 0 ? 1 : 0), part);
    for (std::size_t swaps = below(3); swaps > 0 && !line.empty(); --swaps)
      std::swap(line[below(line.size())], line[below(line.size())]);
    for (const canfd_frame& part : sent[0].all()) line.push_back(part);
    Reassembly receiver(Channel::kA);
    Arrival last;
    for (const canfd_frame& part : line) {
      last = receiver.arrive(part);
      if (last.outcome != Outcome::kComplete) continue;
      ++complete;
      const Bytes bytes = bytes_of(last.frame);
      ASSERT_TRUE(bytes == frames[0] || bytes == frames[1]) << trial;
    }
    ASSERT_EQ(last.outcome, Outcome::kComplete) << trial;
    ASSERT_EQ(bytes_of(last.frame), frames[0]) << trial;
  }
  EXPECT_GT(complete, 3000u);
}

}  // namespace
}  // namespace ttf::bus::socketcan
