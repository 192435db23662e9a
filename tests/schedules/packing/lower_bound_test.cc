#include "schedules/packing/lower_bound.h"

#include <gtest/gtest.h>

namespace ttf::schedules::packing {
namespace {

Instance instance_of(int payload, int cycles, const std::vector<Signal>& signals, int nodes = 1, bool shared = false) {
  return {std::vector<std::string>(static_cast<std::size_t>(nodes)), signals, payload, cycles, shared};
}

int bound_of(const Instance& instance) { return least_bins(instance, possible_signals(instance)); }

Signal free_signal(int repetition, int bits, int node = 0) {
  return {"s", node, repetition, {0, repetition - 1}, bits};
}

TEST(LowerBound, IsTheLoadOfShortSignals) {
  std::vector<Signal> signals(9, free_signal(2, 4));  // 9 * 4 / 2 = 18 bits a cycle
  EXPECT_EQ(bound_of(instance_of(8, 4, signals)), 3);
  EXPECT_DOUBLE_EQ(load(instance_of(8, 4, signals), possible_signals(instance_of(8, 4, signals))), 18.0 / 8);
  EXPECT_EQ(bound_of(instance_of(8, 4, {})), 0);
}

TEST(LowerBound, TwoLongSignalsNeverShareAFrame) {
  // Three signals of 5 of 8 bits: the load is 15 / 8, so 2 bins. But each fills a frame.
  EXPECT_EQ(bound_of(instance_of(8, 1, std::vector<Signal>(3, free_signal(1, 5)))), 3);
  // With one of 4 bits besides: it does not fit beside 5 bits, either.
  std::vector<Signal> signals(3, free_signal(1, 5));
  signals.push_back(free_signal(1, 4));
  EXPECT_EQ(bound_of(instance_of(8, 1, signals)), 4);
  // One of 3 bits does.
  signals.back().bits = 3;
  EXPECT_EQ(bound_of(instance_of(8, 1, signals)), 3);
}

TEST(LowerBound, WindowsNeedBinsInTheirCyclesAlone) {
  // Four whole frames of every 4th cycle: one bin, if they may be anywhere; four, if all are in cycle 0; two in 0..1.
  std::vector<Signal> signals(4, free_signal(4, 8));
  EXPECT_EQ(bound_of(instance_of(8, 8, signals)), 1);
  for (Signal& signal : signals) signal.window = {0, 1};
  EXPECT_EQ(bound_of(instance_of(8, 8, signals)), 2);
  for (Signal& signal : signals) signal.window = {0, 0};
  EXPECT_EQ(bound_of(instance_of(8, 8, signals)), 4);
}

TEST(LowerBound, AClassOfCyclesIsAWhole) {
  // Five half frames of every 2nd cycle lie in three classes of even or odd cycles, six frames in all. Two shared slots
  // of 4 cycles have two frames more. The other node sends three whole frames in every 4th cycle.
  std::vector<Signal> signals(5, free_signal(2, 4, 0));
  for (int i = 0; i < 3; ++i) signals.push_back(free_signal(4, 8, 1));
  EXPECT_EQ(bound_of(instance_of(8, 4, signals, 2, true)), 3);
}

TEST(LowerBound, ASharedSlotsFrameHasOneNode) {
  // Two nodes with half a frame in every 2nd cycle each: half a bin by load, but each needs a frame of its own.
  const std::vector<Signal> signals{free_signal(2, 4, 0), free_signal(2, 4, 1), free_signal(2, 4, 0)};
  EXPECT_EQ(bound_of(instance_of(8, 2, signals, 2, true)), 1);
  const std::vector<Signal> three{free_signal(2, 4, 0), free_signal(2, 4, 1), free_signal(2, 4, 2)};
  EXPECT_EQ(bound_of(instance_of(8, 2, three, 3, true)), 2);
  // The other node needs a second slot: all frames of the slot belong to node 0.
  const std::vector<Signal> fast{free_signal(1, 4, 0), free_signal(2, 4, 1)};
  EXPECT_EQ(bound_of(instance_of(8, 2, fast, 2, true)), 2);
}

}  // namespace
}  // namespace ttf::schedules::packing
