#include "schedules/packing/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ttf::schedules::packing {
namespace {

using model::Channels;
using ::testing::HasSubstr;

// Two signals of node a and one of b, in frames of 8 bits over 4 cycles.
Instance three_signals(bool shared = false) {
  return {{"a", "b"}, {{"x", 0, 2, {0, 1}, 4}, {"y", 0, 4, {1, 2}, 4}, {"z", 1, 4, {0, 3}, 4}}, 8, 4, shared};
}
Assignment sound() {
  return {Assigned{{1, Channels::kA}, 0, 0}, Assigned{{1, Channels::kA}, 2, 4}, Assigned{{2, Channels::kA}, 0, 0}};
}

void expect_violation(const Instance& instance, const Assignment& assignment, std::size_t signal, const char* text) {
  const std::vector<Violation> found = violations(instance, assignment);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].signal, signal);
  EXPECT_THAT(found[0].text, HasSubstr(text));
}

TEST(PackingCheck, ASoundPackingPasses) {
  EXPECT_TRUE(violations(three_signals(), sound()).empty());
  EXPECT_TRUE(violations(three_signals(), Assignment(3)).empty());
}

TEST(PackingCheck, AnOverlapNamesBothSignalsAndThePlace) {
  Assignment assignment = sound();
  assignment[1]->offset = 3;  // x has bits 0..3 in cycles 0 and 2
  expect_violation(three_signals(), assignment, 1, "overlaps signal x at bit 3 of slot 1 in cycle 2");
}

TEST(PackingCheck, AWindowHolds) {
  Assignment assignment = sound();
  assignment[1]->first_cycle = 3;
  expect_violation(three_signals(), assignment, 1, "must have its first cycle in 1..2, not in 3");
  Instance instance = three_signals();
  instance.signals[1].window = {1, 0};
  expect_violation(instance, sound(), 1, "cannot meet its own window");
}

TEST(PackingCheck, BitsLieWithinTheFrame) {
  for (const int offset : {-1, 5}) {
    Assignment assignment = sound();
    assignment[2]->offset = offset;
    expect_violation(three_signals(), assignment, 2, "within the 8 of a frame");
  }
}

TEST(PackingCheck, ASlotHasANumber) {
  Assignment assignment = sound();
  assignment[2]->number.slot = 1024;
  expect_violation(three_signals(), assignment, 2, "must have a slot of 0..1023, not 1024");
}

TEST(PackingCheck, ASlotHasOneOwner) {
  Assignment assignment = sound();
  assignment[2] = Assigned{{1, Channels::kA}, 1, 0};
  expect_violation(three_signals(), assignment, 2, "must not be in slot 1, which belongs to node a of signal x");
  // Sharing slots, a cycle of its own is enough; a frame of x is not.
  EXPECT_TRUE(violations(three_signals(true), assignment).empty());
  assignment[2] = Assigned{{1, Channels::kA}, 0, 4};
  expect_violation(three_signals(true), assignment, 2, "must not be in slot 1 of cycle 0, which belongs to node a");
}

TEST(PackingCheck, ChannelsAreApart) {
  Assignment assignment = sound();
  assignment[2] = Assigned{{1, Channels::kB}, 0, 0};
  EXPECT_TRUE(violations(three_signals(), assignment).empty());
  assignment[2]->number.channels = Channels::kAB;
  expect_violation(three_signals(), assignment, 2, "belongs to node a");
}

}  // namespace
}  // namespace ttf::schedules::packing
