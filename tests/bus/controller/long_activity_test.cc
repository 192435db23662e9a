// Activity that lasts longer than a slot: the slots that it covers are no silence.
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "tests/bus/alone.h"

namespace ttf::bus::controller {
namespace {

constexpr SlotStatus kFound = kSyntaxError | kBoundaryViolation;  // where it began; elsewhere the boundary alone
using Statuses = std::map<int, SlotStatus>;

// Node 1 receives slots 1 and 3..8, sends in slot 2 and, in odd cycles, in slot 9. Slot 10 is unassigned.
struct Listener : Alone {
  Listener() : Alone(1) {}

  // An undecodable activity takes the channel. It begins and ends between two slots' boundaries.
  void noise(std::int64_t from_cycle, int from_slot, std::int64_t to_cycle, int to_slot,
             Channel channel = Channel::kA) {
    const Microticks start = middle(from_cycle, from_slot), end = middle(to_cycle, to_slot);
    controller.advance(start);
    port.busy[index_of(channel)] = true;
    controller.advance(end - Microticks{1});
    port.busy[index_of(channel)] = false;
    controller.receive({channel, ports::Signal::kUndecodable, start, end, {}});
  }
  void frames(std::int64_t cycle, std::vector<int> in_slots) {
    for (const int slot : in_slots) {
      Frame frame = Frame::status(slot, cycle);
      frame.header.null_frame = slot > 4;  // without a fragment
      frame.arrive(*this);
    }
  }
  static Microticks middle(std::int64_t cycle, int slot) { return at(cycle, 84 * (slot - 1) + 42); }
  Statuses reported(std::int64_t cycle, Channel channel = Channel::kA) const {
    Statuses slots;
    for (const auto& problem : reports.problems)
      if (problem.cycle == cycle && problem.channel == channel) slots[problem.slot] |= problem.status;
    return slots;
  }
  // The host's view of the segment that ended last.
  Statuses read(Channel channel = Channel::kA) const {
    Statuses slots;
    for (int slot = 1; slot <= 10; ++slot) {
      const SlotSeen seen = controller.slot_status(slot, channel);
      EXPECT_FALSE(seen.content_error || seen.transmission_conflict) << slot;
      const SlotStatus status = (seen.syntax_error ? kSyntaxError : kValidFrame) |
                                (seen.boundary_violation ? kBoundaryViolation : kValidFrame);
      if (status != kValidFrame) slots[slot] = status;
    }
    return slots;
  }
};

TEST(LongActivity, ViolatesTheBoundariesOfEverySlotItTouches) {
  Listener node;
  node.frames(0, {1});
  node.noise(0, 3, 0, 5);
  node.frames(0, {6, 7, 8});
  node.run_to(1);
  EXPECT_EQ(node.reported(0), (Statuses{{3, kFound}, {4, kBoundaryViolation}, {5, kBoundaryViolation}}));
  EXPECT_EQ(node.read(), node.reported(0));
  for (const auto& [slot, status] : node.reported(0, Channel::kB)) EXPECT_EQ(status, kNoFrame) << slot;
  EXPECT_EQ(node.reported(0, Channel::kB).size(), 7u);
}

// Its own slot and unassigned ones are affected like any other.
TEST(LongActivity, OfWhoeverTheSlotIs) {
  Listener node;
  node.frames(1, {1, 3, 4, 5, 6});
  node.noise(1, 7, 1, 10);
  node.run_to(2);
  EXPECT_EQ(node.reported(1), (Statuses{{7, kFound | kTransmissionConflict},
                                        {8, kBoundaryViolation},
                                        {9, kBoundaryViolation},
                                        {10, kBoundaryViolation}}));
}

TEST(LongActivity, AFrameBehindItInItsLastSlotIsValidAllTheSame) {
  Listener node;
  Frame late = Frame::status(5, 0);
  node.noise(0, 3, 0, 5);
  late.header.null_frame = true;
  late.start = Listener::middle(0, 5).value + 100;
  late.arrive(node);
  node.run_to(1);
  EXPECT_EQ(node.controller.slot_status(5, Channel::kA), (SlotSeen{.valid_frame = true, .boundary_violation = true}));
}

// The activity covers no slot that begins at its end: that slot is silent.
TEST(LongActivity, EndsWithTheSlotThatItEndsIn) {
  Listener node;
  node.frames(0, {1});
  node.controller.receive(
      {Channel::kA, ports::Signal::kUndecodable, Listener::middle(0, 3), Listener::at(0, 84 * 4), {}});
  node.run_to(1);
  const Statuses reported = node.reported(0);
  EXPECT_EQ(reported.at(3), kFound);
  EXPECT_EQ(reported.at(4), kBoundaryViolation);
  EXPECT_EQ(reported.at(5), kNoFrame);
}

// From the cycle before: reported outside every slot, since it began there, and in all slots it reaches.
TEST(LongActivity, AcrossACycleStart) {
  Listener node;
  node.frames(0, {1, 3, 4, 5, 6, 7, 8});
  const Microticks start = Listener::at(0, 950), end = Listener::middle(1, 3);
  node.controller.advance(start);
  node.port.busy[0] = true;
  node.controller.advance(end - Microticks{1});
  node.port.busy[0] = false;
  node.controller.receive({Channel::kA, ports::Signal::kUndecodable, start, end, {}});
  node.frames(1, {4, 5, 6, 7, 8});
  node.run_to(2);
  EXPECT_EQ(node.reported(0), Statuses{});
  const Statuses slots{{1, kBoundaryViolation}, {2, kBoundaryViolation}, {3, kBoundaryViolation}};
  EXPECT_EQ(node.read(), slots);
  Statuses with_outside = slots;
  with_outside[0] = kFound | kTransmissionConflict;  // its own frame in slot 2
  EXPECT_EQ(node.reported(1), with_outside);
}

// While it lasts, missing frames are unknown, but the channel is known not to be silent.
TEST(LongActivity, OverWholeCycles) {
  Listener node;
  std::vector<Statuses> read;
  node.reports.on_static_segment_ended = [&](std::int64_t) { read.push_back(node.read()); };
  node.frames(0, {1, 3});
  node.noise(0, 5, 3, 4);
  node.frames(3, {5, 6, 7, 8});
  node.run_to(4);
  Statuses every;
  for (int slot = 1; slot <= 10; ++slot) every[slot] = kBoundaryViolation;
  // It is taken to have begun behind slot 3. Slots 9 and 10 are not due in cycle 0, except for the boundary
  // where it ends.
  const Statuses first{{4, kBoundaryViolation}, {5, kBoundaryViolation}, {6, kBoundaryViolation},
                       {7, kBoundaryViolation}, {8, kBoundaryViolation}, {10, kBoundaryViolation}};
  const Statuses last{
      {1, kBoundaryViolation}, {2, kBoundaryViolation}, {3, kBoundaryViolation}, {4, kBoundaryViolation}};
  EXPECT_EQ(read, (std::vector<Statuses>{first, every, every, last}));
  EXPECT_EQ(node.reported(0), first);
  EXPECT_EQ(node.reported(1), every);
  EXPECT_EQ(node.reported(2), every);
  Statuses last_reported = last;
  last_reported[0] = node.reported(3).at(0);
  EXPECT_EQ(node.reported(3), last_reported);
  EXPECT_EQ(last_reported[0] | kFound, last_reported[0]);
  for (std::int64_t cycle = 0; cycle < 4; ++cycle)
    for (const auto& [slot, status] : node.reported(cycle, Channel::kB)) EXPECT_EQ(status, kNoFrame) << slot;
}

// A slot that was silent before the activity stays silent.
TEST(LongActivity, IsNoExcuseForWhoWasSilentBefore) {
  Listener node;
  node.frames(0, {4, 5, 6, 7, 8});
  node.noise(0, 9, 1, 1);
  node.run_to(1, 100);
  EXPECT_EQ(node.reported(0), (Statuses{{1, kNoFrame}, {3, kNoFrame}, {10, kBoundaryViolation}}));
}

// Two signals with silence between them: only the second is under way when the segment ends.
TEST(LongActivity, OneThatEndedAfterTheCycleBeganDoesNotCoverTheCycle) {
  Listener node;
  node.noise(0, 10, 1, 1);
  node.frames(1, {3, 4});
  node.noise(1, 8, 2, 1);
  node.run_to(2, 500);
  const Statuses reported = node.reported(1);
  EXPECT_EQ(reported.at(1), kBoundaryViolation);
  EXPECT_EQ(reported.count(2), 0u);
  EXPECT_EQ(reported.count(3), 0u);
  EXPECT_EQ(reported.at(10), kBoundaryViolation);
  EXPECT_EQ(reported.count(9), 0u);
}

}  // namespace
}  // namespace ttf::bus::controller
