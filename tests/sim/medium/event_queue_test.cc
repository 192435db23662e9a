#include "sim/medium/event_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/random.h"

namespace ttf::sim::medium {
namespace {

// At one instant: phase, then node, then order of scheduling, from any order of scheduling.
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

// Among simultaneous arrivals at one receiver, the rank decides after the receiver and before the order of
// scheduling.
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

// Scheduled, popped and gone on with in any order, against a sorted list.
TEST(EventQueue, TheSameAsASortedList) {
  for (std::uint16_t seed = 0; seed < 10; ++seed) {
    RandomStream draw({1, 0, Purpose::kTest, seed, 0});
    EventQueue<int> queue(4);
    std::vector<std::pair<EventOrder, int>> sorted;
    const auto add = [&sorted](const EventOrder& order, int payload) {
      const auto before = [](const EventOrder& one, const auto& other) { return one < other.first; };
      sorted.insert(std::upper_bound(sorted.begin(), sorted.end(), order, before), {order, payload});
    };
    TrueTime now{};
    for (int i = 0; i < 2'000; ++i) {
      ASSERT_EQ(queue.empty(), sorted.empty());
      if (sorted.empty() || draw.integer(0, 99) < 50) {
        const TrueTime at = now + Duration{draw.integer(0, 20)};
        const auto phase = static_cast<Phase>(draw.integer(0, 3));
        const auto node = static_cast<std::uint8_t>(draw.integer(0, 3));
        const auto rank = static_cast<std::uint16_t>(draw.integer(0, 2));
        const std::uint64_t sequence = queue.schedule(at, phase, node, i, rank);
        add({at, phase, node, rank, sequence}, i);
        continue;
      }
      ASSERT_EQ(queue.next(), sorted.front().first);
      ASSERT_EQ(queue.pop(), sorted.front().second);
      auto [order, payload] = sorted.front();
      now = order.time;
      sorted.erase(sorted.begin());
      if (draw.integer(0, 2) == 0) continue;
      order.time = order.time + Duration{draw.integer(0, 20)};
      order.node = 4;
      ASSERT_EQ(queue.is_first(order), sorted.empty() || order < sorted.front().first);
      queue.go_on(order, payload);
      add(order, payload);
    }
  }
}

}  // namespace
}  // namespace ttf::sim::medium
