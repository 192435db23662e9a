// A controller's judgement of received frames (slot status).
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/bus/alone.h"

namespace ttf::bus::controller {
namespace {

// One frame each, with one error each. Returns the controller's status of its slot in cycle 0.
SlotStatus status_of(const Frame& frame, int slot, std::int64_t cycle = 0) {
  Alone node;
  frame.arrive(node);
  node.run_to(cycle + 1);
  for (const auto& problem : node.reports.problems)
    if (problem.cycle == cycle && problem.slot == slot && problem.channel == frame.channel) return problem.status;
  return kValidFrame;
}

TEST(ControllerJudges, ARightFrameIsNoProblem) {
  EXPECT_EQ(status_of(Frame::status(2, 0), 2), kValidFrame);
  EXPECT_EQ(status_of(Frame::status(2, 0, Channel::kB), 2), kValidFrame);
  EXPECT_EQ(status_of(Frame::status(4, 0), 4), kValidFrame);
}

TEST(ControllerJudges, SilenceInAnOwnedSlotPerChannel) {
  Alone node;
  Frame::status(2, 0).arrive(node);  // channel A only
  node.run_to(1);
  std::vector<std::pair<int, Channel>> silent;
  for (const auto& problem : node.reports.problems) {
    EXPECT_EQ(problem.status, kNoFrame);
    silent.emplace_back(problem.slot, problem.channel);
  }
  // Slots 1 and 5..8 are its own, 9 is sent in odd cycles, 10 is unassigned.
  EXPECT_EQ(silent, (std::vector<std::pair<int, Channel>>{
                        {2, Channel::kB}, {3, Channel::kA}, {3, Channel::kB}, {4, Channel::kA}, {4, Channel::kB}}));
  node.run_to(2);
  const auto& last = node.reports.problems.back();
  EXPECT_EQ(last.slot, 9);
  EXPECT_EQ(last.channel, Channel::kA);  // B is not expected to carry it
}

TEST(ControllerJudges, SyntaxErrors) {
  for (const std::size_t byte : {1u, 7u, 22u}) {  // header, payload, trailer
    Alone node;
    const Frame frame = Frame::status(2, 0);
    auto bytes = frame.bytes();
    bytes[byte] ^= std::byte{0x10};
    node.controller.receive(received(Channel::kA, {frame.start}, {frame.start + 1000}, bytes));
    node.run_to(1);
    ASSERT_FALSE(node.reports.problems.empty());
    EXPECT_EQ(node.reports.problems[0].slot, 2);
    EXPECT_EQ(node.reports.problems[0].status, kSyntaxError);
  }
}

TEST(ControllerJudges, AFrameOfTheOtherChannelIsASyntaxError) {
  Alone node;
  const Frame frame = Frame::status(2, 0, Channel::kA);
  const auto bytes = frame.bytes();
  node.controller.receive(received(Channel::kB, {frame.start}, {frame.start + 1000}, bytes));
  node.run_to(1);
  const auto swapped =
      std::find_if(node.reports.problems.begin(), node.reports.problems.end(),
                   [](const auto& problem) { return problem.slot == 2 && problem.channel == Channel::kB; });
  ASSERT_NE(swapped, node.reports.problems.end());
  EXPECT_EQ(swapped->status, kSyntaxError);
}

TEST(ControllerJudges, ContentErrors) {
  Frame other_id = Frame::status(2, 0);
  other_id.header.frame_id = 3;
  EXPECT_EQ(status_of(other_id, 2), kContentError);
  Frame other_cycle = Frame::status(2, 0);
  other_cycle.header.cycle = 1;
  EXPECT_EQ(status_of(other_cycle, 2), kContentError);
  Frame shorter = Frame::status(2, 0);
  shorter.payload.resize(14);
  EXPECT_EQ(status_of(shorter, 2), kContentError);
  Frame startup_only = Frame::status(2, 0);
  startup_only.header.sync = false;
  EXPECT_EQ(wire::decode_frame(Channel::kA, startup_only.bytes()).error, wire::FrameError::kNone);
  EXPECT_EQ(status_of(startup_only, 2), kContentError);
  // The receiver's own slot: it is sending, and cannot decode anything.
  EXPECT_EQ(status_of(Frame::status(5, 0), 5), kTransmissionConflict | kSyntaxError);
}

// The schedule has no say in validity. It calls a valid frame unexpected.
TEST(ControllerJudges, AValidFrameThatTheScheduleHasNotIsUnexpected) {
  EXPECT_EQ(status_of(Frame::status(10, 0), 10), kUnexpectedFrame);                // an unassigned slot
  EXPECT_EQ(status_of(Frame::status(9, 0), 9), kUnexpectedFrame);                  // not in even cycles
  EXPECT_EQ(status_of(Frame::status(9, 1, Channel::kB), 9, 1), kUnexpectedFrame);  // not on B
  EXPECT_EQ(status_of(Frame::status(9, 1), 9, 1), kValidFrame);
  // A content error is the only verdict where a frame has one.
  Frame other_cycle = Frame::status(10, 0);
  other_cycle.header.cycle = 1;
  EXPECT_EQ(status_of(other_cycle, 10), kContentError);
}

// In 2.1A clock synchronisation asks only whether a sync frame is valid.
TEST(ControllerJudges, AnUnexpectedSyncFrameEntersClockSynchronisation) {
  Alone node;
  for (const std::int64_t cycle : {0, 1}) {
    Frame rogue = Frame::status(10, cycle);
    rogue.header.sync = true;
    rogue.start += 60;
    rogue.arrive(node);
    Frame same = rogue;
    same.channel = Channel::kB;
    same.arrive(node);
  }
  node.run_to(2);
  EXPECT_EQ(node.controller.slot_status(10, Channel::kA), (SlotSeen{.valid_frame = true, .unexpected_frame = true}));
  EXPECT_EQ(node.controller.sync_status().VSAO, 2);  // with its own
  ASSERT_EQ(node.reports.corrected.size(), 1u);
  EXPECT_EQ(node.reports.corrected[0].offset.value, 30);  // half way between its own and the other
}

// The segment's report is out when its last frame ends. The frame is reported by itself.
TEST(ControllerJudges, AnUnexpectedFrameAtTheSegmentsEndIsReported) {
  Alone node;
  Frame last = Frame::status(10, 0);
  last.start = Alone::at(0, 840).value - last.length;
  node.controller.advance({last.start + last.length});
  const auto bytes = last.bytes();
  node.controller.receive(received(Channel::kA, {last.start}, {last.start + last.length}, bytes));
  EXPECT_EQ(std::ranges::count_if(node.reports.problems,
                                  [](const auto& one) { return one.slot == 10 && one.status == kUnexpectedFrame; }),
            1);
}

// A frame must lie within the receiver's own slot, both ends included.
TEST(ControllerJudges, BoundaryViolations) {
  const std::int64_t begin = Alone::at(0, 84).value, end = Alone::at(0, 168).value;  // slot 2
  Frame frame = Frame::status(2, 0);
  frame.start = begin;
  EXPECT_EQ(status_of(frame, 2), kValidFrame);
  frame.start = end - frame.length;
  EXPECT_EQ(status_of(frame, 2), kValidFrame);
  frame.start = end - frame.length + 1;
  EXPECT_EQ(status_of(frame, 2), kBoundaryViolation);
  // One microtick early it begins in slot 1 and ends in slot 2: it violates the boundary of both.
  frame.start = begin - 1;
  EXPECT_EQ(status_of(frame, 1), kBoundaryViolation);
  EXPECT_EQ(status_of(frame, 2), kBoundaryViolation);
}

TEST(ControllerJudges, ASecondCommunicationElementInASlotIsASyntaxError) {
  Alone node;
  Frame first = Frame::status(2, 0), second = Frame::status(2, 0);
  first.arrive(node);
  second.start = first.start + 1500;
  second.arrive(node);
  node.run_to(1);
  EXPECT_EQ(node.reports.problems[0].slot, 2);
  EXPECT_EQ(node.reports.problems[0].status, kSyntaxError);
}

TEST(ControllerJudges, WrongFramesReachNeitherTheHostNorTheClock) {
  Alone node(1);
  MadeList list(node.cluster.pdus[0], 1, 3, 0);
  Frame carrier = Frame::status(5, 0);
  std::copy(list.bytes.begin(), list.bytes.end(), carrier.payload.begin());
  carrier.header.cycle = 1;
  carrier.arrive(node);
  EXPECT_TRUE(node.reports.arrived.empty());
  for (const int slot : {1, 3, 4}) {
    Frame late = Frame::status(slot, 1);
    late.start += 100;
    late.header.cycle = 2;
    late.arrive(node);
  }
  node.run_to(2);
  ASSERT_EQ(node.reports.corrected.size(), 1u);
  EXPECT_EQ(node.reports.corrected[0].offset.value, 0);  // only its own sync frame counts
}

// Slot 5 is for fragment 0 of the list, slot 6 for fragment 1. The frame is valid, its payload not the slot's.
TEST(ControllerJudges, AFragmentInAnotherOnesSlotIsUnexpected) {
  Alone node(1);
  MadeList list(node.cluster.pdus[0], 1, 6, 0);
  const auto carry = [&](int slot, int fragment) {
    Frame carrier = Frame::status(slot, 0);
    const auto bytes = list.fragment(fragment);
    std::copy(bytes.begin(), bytes.end(), carrier.payload.begin());
    carrier.arrive(node);
  };
  carry(5, 1);
  carry(6, 1);
  node.run_to(1);
  ASSERT_EQ(node.reports.arrived.size(), 2u);
  EXPECT_EQ(node.reports.arrived[0].effect, cni::ArrivalEffect::kMalformed);
  EXPECT_EQ(node.reports.arrived[1].effect, cni::ArrivalEffect::kIncomplete);
  int errors = 0;
  for (const auto& problem : node.reports.problems) {
    if (problem.slot == 5 && problem.channel == Channel::kA) {
      EXPECT_EQ(problem.status, kUnexpectedFrame);
      ++errors;
    }
    if (problem.slot == 6) {
      EXPECT_NE(problem.channel, Channel::kA);
    }
  }
  EXPECT_EQ(errors, 1);
}

TEST(ControllerJudges, ANullFrameIsValidAndLeavesTheListAlone) {
  Alone node(1);
  Frame frame = Frame::status(5, 0);
  frame.header.null_frame = true;
  frame.arrive(node);
  node.run_to(1);
  EXPECT_TRUE(node.reports.arrived.empty());
  for (const auto& problem : node.reports.problems) EXPECT_FALSE(problem.slot == 5 && problem.channel == Channel::kA);
}

}  // namespace
}  // namespace ttf::bus::controller
