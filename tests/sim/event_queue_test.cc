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

}  // namespace
}  // namespace ttf::sim
