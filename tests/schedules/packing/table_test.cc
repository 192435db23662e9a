// Windows, numbers of slots, and the room that is left.
#include <gtest/gtest.h>

#include "schedules/packing/first_fit.h"
#include "schedules/packing/packer.h"
#include "schedules/packing/room.h"
#include "schedules/packing/slot_numbers.h"
#include "tests/schedules/packing/like_instance.h"

namespace ttf::schedules::packing {
namespace {

using model::Channel;
using model::Channels;

Window window_ms(int release, int deadline, int repetition) {
  return window_of(Duration::milliseconds(5), Duration::milliseconds(release), Duration::milliseconds(deadline),
                   repetition);
}

TEST(PackingWindow, CyclesBeginAtTheReleaseOrLaterAndBeforeTheDeadline) {
  EXPECT_EQ(window_ms(0, 40, 8), (Window{0, 7}));
  EXPECT_EQ(window_ms(0, 39, 8), (Window{0, 7}));
  EXPECT_EQ(window_ms(0, 35, 8), (Window{0, 6}));
  EXPECT_EQ(window_ms(10, 29, 8), (Window{2, 5}));
  EXPECT_EQ(window_ms(11, 29, 8), (Window{3, 5}));
  EXPECT_EQ(window_ms(0, 4, 1), (Window{0, 0}));
}

TEST(PackingWindow, MayBeEmpty) {
  EXPECT_TRUE(window_ms(5, 5, 1).empty());
  EXPECT_TRUE(window_ms(1, 5, 2).empty());
  EXPECT_TRUE(window_ms(0, 0, 4).empty());
  EXPECT_TRUE(window_ms(40, 40, 8).empty());
}

TEST(SlotNumbers, OneChannelCountsFromTheFirstFreeSlot) {
  const auto numbers = slot_numbers({{3, Channels::kA}}, 4, 2, ChannelUse::kOne);
  ASSERT_EQ(numbers.size(), 4u);
  const std::vector<int> slots{numbers[0].slot, numbers[1].slot, numbers[2].slot, numbers[3].slot};
  EXPECT_EQ(slots, (std::vector{3, 2, 4, 5}));
}

TEST(SlotNumbers, TheSameContentIsOnBothChannels) {
  const auto numbers = slot_numbers({}, 3, 1, ChannelUse::kSame);
  EXPECT_EQ(numbers[2], (SlotNumber{3, Channels::kAB}));
  EXPECT_EQ(slots_on(numbers, Channel::kA), 3);
  EXPECT_EQ(slots_on(numbers, Channel::kB), 3);
}

TEST(SlotNumbers, IndependentChannelsHaveHalfOfTheBinsEach) {
  for (const int bins : {0, 1, 2, 7, 8}) {
    const auto numbers = slot_numbers({}, bins, 1, ChannelUse::kIndependent);
    EXPECT_EQ(slots_on(numbers, Channel::kA), (bins + 1) / 2);
    EXPECT_EQ(slots_on(numbers, Channel::kB), bins / 2);
  }
  const auto grown = slot_numbers({{1, Channels::kA}, {2, Channels::kA}}, 5, 1, ChannelUse::kIndependent);
  EXPECT_EQ(slots_on(grown, Channel::kA), 3);
  EXPECT_EQ(slots_on(grown, Channel::kB), 2);
}

// The room is exact: so many signals fit into the bins, and one more does not.
TEST(RoomLeft, IsFilledExactly) {
  for (const bool shared : {false, true}) {
    Instance instance = like_instance(250, 2);
    instance.shared_slots = shared;
    const Solution solution = pack(instance);
    const auto rooms = room_left(instance, solution.places, 3);
    ASSERT_EQ(rooms.size(), 6u);
    for (const Room& room : rooms)
      for (std::size_t k = 0; k < room.signals.size(); ++k) {
        Packed packed = with_fixed(instance, solution.places);
        Signal more{"more", room.node, 1 << k, {0, (1 << k) - 1}, 3};
        int added = 0;
        for (std::size_t b = 0; b < packed.bins.size(); ++b) {
          const bool own = std::any_of(solution.places.begin(), solution.places.end(), [&](const auto& place) {
            return place && place->bin == static_cast<int>(b) &&
                   instance.signals[static_cast<std::size_t>(&place - solution.places.data())].node == room.node;
          });
          if (!own && !shared) continue;
          while (const auto place = packed.bins[b].first_place(more, Fit::kLowestBit)) {
            packed.bins[b].occupy(more, *place);
            ++added;
          }
        }
        EXPECT_EQ(room.signals[k], added) << "node " << room.node << " repetition " << (1 << k);
      }
  }
}

TEST(RoomLeft, FreeBitsAreThoseThatNoSignalHas) {
  const Instance instance = like_instance(400, 4);
  const Solution solution = pack(instance);
  const auto rooms = room_left(instance, solution.places, 8);
  for (std::size_t node = 0; node < rooms.size(); ++node) {
    const Part& part = solution.parts[node];
    EXPECT_EQ(rooms[node].free_bits, std::int64_t{part.bins} * 64 * 32 - part.used_bits);
  }
}

}  // namespace
}  // namespace ttf::schedules::packing
