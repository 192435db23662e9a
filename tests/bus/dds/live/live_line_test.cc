// Lines of a real-time medium over DDS: their names, numbering and queues.
#include "bus/dds/live/line.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <cstdint>
#include <set>
#include <string>
#include <thread>

#include "bus/dds/common/host_identity.h"
#include "bus/dds/live/numbering.h"
#include "bus/dds/live/queue.h"

namespace ttf::bus::dds::live {
namespace {

TEST(DdsLiveTopic, HasOnlyWhatDdsAllowsAndNoTwoAreTheSame) {
  EXPECT_EQ(live_topic(schedules::model::Channel::kA), "ttf/flexray/A");
  EXPECT_EQ(live_topic(schedules::model::Channel::kB), "ttf/flexray/B");
  EXPECT_EQ(live_can_topic("laser_can"), "ttf/can/laser_can");
  EXPECT_EQ(live_can_topic("laser-can"), "ttf/can/laser_2Dcan");
  EXPECT_EQ(live_can_topic("laser_2Dcan"), "ttf/can/laser_5F2Dcan");
  EXPECT_EQ(live_can_topic("\xC3\xA9 2"), "ttf/can/_C3_A9_202");
  std::set<std::string> topics;
  for (const char* name : {"a", "_a", "_", "__", "_5F", "-", "_2D", "_2d", "_5F2D", "/", "_2", "2"})
    EXPECT_TRUE(topics.insert(live_can_topic(name)).second) << name;
}

TEST(DdsLiveNumbering, CountsGapsButNotAcrossABeginning) {
  LiveNumbering numbering;
  const NodeId a{1}, b{2};
  EXPECT_EQ(numbering.missing_before(a, 7, 100), 0u);  // earlier messages do not concern us
  EXPECT_EQ(numbering.missing_before(a, 7, 101), 0u);
  EXPECT_EQ(numbering.missing_before(a, 7, 104), 2u);
  EXPECT_FALSE(numbering.missing_before(a, 7, 104));
  EXPECT_FALSE(numbering.missing_before(a, 7, 102));
  EXPECT_EQ(numbering.missing_before(b, 7, 5), 0u);
  EXPECT_EQ(numbering.missing_before(a, 8, 0), 0u);  // restarted
  EXPECT_EQ(numbering.missing_before(a, 8, 2), 1u);
  EXPECT_EQ(numbering.missing_before(b, 7, 6), 0u);
}

bool readable(const LiveQueue& queue) {
  pollfd poller{queue.descriptor(), POLLIN, 0};
  return poll(&poller, 1, 0) == 1;
}

TEST(DdsLiveQueue, HasRoomForSoMuchAndKeepsTheOrder) {
  LiveQueue queue;
  LiveItem item;
  EXPECT_FALSE(queue.pop(item));
  for (std::size_t round = 0; round < 3; ++round) {
    for (std::size_t i = 0; i < LiveQueue::kRoom; ++i) {
      LiveItem* const place = queue.room();
      ASSERT_NE(place, nullptr);
      place->arrival.signal.slot = static_cast<int>(i);
      queue.push();
    }
    EXPECT_EQ(queue.room(), nullptr);
    for (std::size_t i = 0; i < LiveQueue::kRoom; ++i) {
      ASSERT_TRUE(queue.pop(item));
      EXPECT_EQ(item.arrival.signal.slot, static_cast<int>(i));
    }
    EXPECT_FALSE(queue.pop(item));
  }
}

// A reader that sleeps until the descriptor is readable gets every frame, in any interleaving.
TEST(DdsLiveQueue, NobodySleepsWhileSomethingIsThere) {
  static constexpr int kCount = 200'000;
  LiveQueue queue;
  queue.watch(true);
  std::thread filler([&queue] {
    for (int i = 0; i < kCount;) {
      LiveItem* const place = queue.room();
      if (place == nullptr) continue;
      place->arrival.signal.slot = i++;
      queue.push();
    }
  });
  LiveItem item;
  int next = 0;
  for (int sleeps = 0; next < kCount && sleeps < kCount; ++sleeps) {
    pollfd poller{queue.descriptor(), POLLIN, 0};
    if (poll(&poller, 1, 10'000) != 1) break;
    for (; queue.pop(item); ++next) ASSERT_EQ(item.arrival.signal.slot, next);
  }
  EXPECT_EQ(next, kCount) << "asleep, readable: " << readable(queue);
  filler.join();
  EXPECT_FALSE(queue.pop(item));
  EXPECT_FALSE(readable(queue));
}

TEST(DdsLiveHost, IsTheSameForTheSameProcess) {
  EXPECT_EQ(common::host_identity(), common::host_identity());
  EXPECT_NE(common::host_identity(), 0u);
}

}  // namespace
}  // namespace ttf::bus::dds::live
