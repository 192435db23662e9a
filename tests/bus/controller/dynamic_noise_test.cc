// The dynamic segment of a channel with an activity that is already under way when the segment begins. Nodes
// wait for its end and count on from there, all of them the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/bus/dynamic_cluster.h"

namespace ttf::bus::controller {
namespace {

// Three nodes with a list each, written before cycle kCycle, in which channel A is noisy.
constexpr std::int64_t kCycle = 2;

TrueTime at(std::int64_t cycle, std::int64_t macrotick) {
  return Rig::kStart + Duration::milliseconds(cycle) + Duration{1000 * macrotick};
}
// In the middle of a minislot.
TrueTime in_minislot(int minislot) { return at(kCycle, kSegment + 5 * (minislot - 1) + 2); }

struct Noisy {
  Rig rig{dynamic_cluster(3), {0, 0, 0}};

  Noisy(TrueTime from, TrueTime to) {
    rig.run_cycles(kCycle - 1);
    rig.run_until(at(kCycle - 1, 980));
    for (std::size_t node = 0; node < 3; ++node) {
      write(rig, node, 1);
      rig.medium().put({from, to, Channel::kA, 9, node, ports::Signal::kUndecodable, {}});
    }
    rig.run_cycles(kCycle + 2);
  }
  // The minislots in which the nodes began to send on A in the noisy cycle; 0: not in that cycle.
  std::vector<int> turns() {
    std::vector<int> minislots;
    for (std::size_t node = 0; node < 3; ++node) {
      minislots.push_back(0);
      for (const Reports::Sent& sent : dynamic_frames(rig, node)) {
        if (sent.cycle != kCycle) continue;
        const auto macrotick = (rig.medium().oscillator(node).time_of(sent.start) - at(kCycle, 0)).ns / 1000;
        minislots.back() = static_cast<int>((macrotick - kSegment) / 5 + 1);
      }
    }
    return minislots;
  }
  // Every node received every list, and the dynamic segment had no errors.
  void expect_all_there() {
    for (std::size_t node = 0; node < 3; ++node) {
      for (const auto& problem : rig.reports(node).problems) EXPECT_LE(problem.slot, 10) << "node " << node;
      for (std::size_t other = 0; other < 3; ++other) {
        if (other == node) continue;
        EXPECT_EQ(arrived(rig, node, static_cast<PduId>(2 + other)), std::vector<std::uint32_t>{1})
            << "node " << node << " of " << other;
      }
    }
  }
};

// A frame takes five minislots and an idle one: dynamic_sending_test.cc.
constexpr int kFrame = 6;

TEST(DynamicNoise, NoiseThatGoesOnWhenTheSegmentBeginsTakesItsFirstSlot) {
  // In the last static slot, between it and the first minislot, and in the cycle before.
  for (const TrueTime from : {at(kCycle, 800), at(kCycle, 842), at(kCycle - 1, 985)})
    for (int last = 1; last <= 7; ++last) {
      SCOPED_TRACE(testing::Message() << "from " << from.ns << " to minislot " << last);
      Noisy noisy(from, in_minislot(last));
      // Slot 11 in minislots 1..last and the idle one behind them, then 12 and 13.
      EXPECT_EQ(noisy.turns(), (std::vector<int>{0, last + 2, last + 2 + kFrame}));
      noisy.expect_all_there();
    }
}

TEST(DynamicNoise, NoiseThatEndsBeforeTheFirstMinislotTakesNoSlot) {
  Noisy noisy(at(kCycle, 800), at(kCycle, 843));
  EXPECT_EQ(noisy.turns(), (std::vector<int>{1, 1 + kFrame, 1 + 2 * kFrame}));
  noisy.expect_all_there();
}

// Begun in the segment: the slot of that minislot, as ever.
TEST(DynamicNoise, NoiseThatBeginsInTheSegmentTakesTheSlotOfItsMinislot) {
  Noisy noisy(in_minislot(1) - Duration{1000}, in_minislot(4));
  EXPECT_EQ(noisy.turns(), (std::vector<int>{0, 6, 6 + kFrame}));
}

TEST(DynamicNoise, NoiseOverTheWholeSegmentLeavesTheNextOneAlone) {
  Noisy noisy(at(kCycle, 800), at(kCycle, 990));
  EXPECT_EQ(noisy.turns(), (std::vector<int>{0, 0, 0}));
  noisy.expect_all_there();  // in the next cycle, on B in this one
}

}  // namespace
}  // namespace ttf::bus::controller
