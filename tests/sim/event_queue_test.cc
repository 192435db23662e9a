#include "sim/event_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace ttf::sim {
namespace {

// At one instant: phase, then node, then order of scheduling; whatever order they were scheduled in.
TEST(EventQueue, OneTotalOrder) {
  EventQueue<int> queue(16);
  queue.schedule(TrueTime{20}, Phase::kArrival, 0, 7);
  queue.schedule(TrueTime{10}, Phase::kArbitration, 0, 5);
  queue.schedule(TrueTime{10}, Phase::kNode, 1, 3);
  queue.schedule(TrueTime{10}, Phase::kNode, 0, 1);
  queue.schedule(TrueTime{10}, Phase::kNode, 0, 2);
  queue.schedule(TrueTime{10}, Phase::kArrival, 9, 0);
  queue.schedule(TrueTime{10}, Phase::kNode, 2, 4);
  queue.schedule(TrueTime{10}, Phase::kObserver, 0, 6);
  for (int expected = 0; expected < 8; ++expected) EXPECT_EQ(queue.pop(), expected);
  EXPECT_TRUE(queue.empty());
}

// Among simultaneous arrivals at one receiver the rank decides, before the order of scheduling and after the receiver.
TEST(EventQueue, RankIsBetweenNodeAndSequence) {
  EventQueue<int> queue(16);
  queue.schedule(TrueTime{10}, Phase::kArrival, 1, 4, 0);
  queue.schedule(TrueTime{10}, Phase::kArrival, 0, 3, 0x0100);
  queue.schedule(TrueTime{10}, Phase::kArrival, 0, 1, 0x0002);
  queue.schedule(TrueTime{10}, Phase::kArrival, 0, 2, 0x0002);
  queue.schedule(TrueTime{10}, Phase::kArrival, 0, 0, 0x0001);
  queue.schedule(TrueTime{10}, Phase::kNode, 0, 5, 0);
  for (int expected = 0; expected < 6; ++expected) EXPECT_EQ(queue.pop(), expected);
  EXPECT_TRUE(queue.empty());
}

}  // namespace
}  // namespace ttf::sim
