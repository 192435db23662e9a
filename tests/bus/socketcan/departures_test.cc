// Reports of departed sync frames, and the meaning of a kernel's stamp: pure.
#include "bus/socketcan/departures.h"

#include <gtest/gtest.h>

#include <limits>

#include "bus/socketcan/stamp.h"
#include "tests/bus/socketcan/frames.h"

namespace ttf::bus::socketcan {
namespace {

using ports::MachineTime;
using schedules::model::Channel;

canfd_frame last_of(int slot, int cycle, int words) {
  const CanFrames can = frame_to_can(slot, drawn_frame(Channel::kA, slot, cycle, words));
  return can.all().back();
}

TEST(Departures, AreReportedOnceWithTheirLateness) {
  Departures departures;
  EXPECT_TRUE(departures.none());
  departures.expect(last_of(3, 17, 8), 3, 17, MachineTime{1'000'000});
  EXPECT_FALSE(departures.none());
  const auto follow_up = departures.left(last_of(3, 17, 8), MachineTime{1'045'163});
  ASSERT_TRUE(follow_up);
  EXPECT_EQ(follow_up->slot, 3);
  EXPECT_EQ(follow_up->cycle_counter, 17);
  EXPECT_EQ(follow_up->late.ns, 45'163);
  EXPECT_TRUE(departures.none());
  EXPECT_FALSE(departures.left(last_of(3, 17, 8), MachineTime{1'045'163}));
}

TEST(Departures, OfOtherFramesAreNot) {
  Departures departures;
  departures.expect(last_of(3, 17, 8), 3, 17, MachineTime{0});
  EXPECT_FALSE(departures.left(last_of(4, 17, 8), MachineTime{0}));
  EXPECT_FALSE(departures.left(last_of(3, 18, 8), MachineTime{0}));
  canfd_frame shorter = last_of(3, 17, 8);
  shorter.len = 20;
  EXPECT_FALSE(departures.left(shorter, MachineTime{0}));
  EXPECT_FALSE(departures.none());
  // The last fragment of a frame gives its departure.
  const CanFrames can = frame_to_can(5, drawn_frame(Channel::kA, 5, 1, 60));
  ASSERT_EQ(can.count, 3u);
  departures.expect(can.all().back(), 5, 1, MachineTime{0});
  EXPECT_FALSE(departures.left(can.frames[0], MachineTime{0}));
  EXPECT_FALSE(departures.left(can.frames[1], MachineTime{0}));
  EXPECT_TRUE(departures.left(can.frames[2], MachineTime{0}));
}

// A driver may have set flags that the sender had not.
TEST(Departures, AreKnownByTheirDataNotTheirFlags) {
  Departures departures;
  departures.expect(last_of(3, 17, 8), 3, 17, MachineTime{100});
  canfd_frame echo = last_of(3, 17, 8);
  echo.flags ^= CANFD_BRS | CANFD_ESI;
  EXPECT_EQ(departures.left(echo, MachineTime{40}).value_or(FollowUp{}).late.ns, -60);
}

TEST(Departures, InAnyOrderAndOnlyTheNewestKept) {
  Departures departures;
  const int all = static_cast<int>(Departures::kRoom) + 3;
  for (int i = 0; i < all; ++i) departures.expect(last_of(7, i, 8), 7, static_cast<std::uint8_t>(i), MachineTime{i});
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(departures.left(last_of(7, i, 8), MachineTime{100})) << i;
  for (int i = all - 1; i >= 3; --i) {
    const auto follow_up = departures.left(last_of(7, i, 8), MachineTime{100});
    ASSERT_TRUE(follow_up) << i;
    EXPECT_EQ(follow_up->cycle_counter, i);
    EXPECT_EQ(follow_up->late.ns, 100 - i);
  }
  EXPECT_TRUE(departures.none());
}

TEST(Departures, TooLateForAFollowUpHaveNone) {
  Departures departures;
  departures.expect(last_of(3, 17, 8), 3, 17, MachineTime{0});
  EXPECT_FALSE(departures.left(last_of(3, 17, 8), MachineTime{0x8000'0000LL}));
  EXPECT_TRUE(departures.none());  // and stays so
}

constexpr ClockPair kPair{.host = {5'000}, .realtime_ns = 1'700'000'000'000'000'000, .now = {5'200}};

TEST(Stamps, AreTheHostsInstantOfTheSameDistance) {
  EXPECT_EQ(on_host(kPair.realtime_ns - 1'234, kPair), MachineTime{3'766});
  EXPECT_EQ(on_host(kPair.realtime_ns, kPair), MachineTime{5'000});
}

TEST(Stamps, AreNeverLaterThanNow) {
  EXPECT_EQ(on_host(kPair.realtime_ns + 200, kPair), MachineTime{5'200});
  EXPECT_EQ(on_host(kPair.realtime_ns + 201, kPair), MachineTime{5'200});
  EXPECT_EQ(on_host(std::numeric_limits<std::int64_t>::max(), kPair), MachineTime{5'200});
}

TEST(Stamps, WhereThereIsNoneItIsNow) {
  EXPECT_EQ(on_host(0, kPair), MachineTime{5'200});
  EXPECT_EQ(on_host(std::numeric_limits<std::int64_t>::min(), kPair), MachineTime{5'200});
}

TEST(Stamps, ClocksAreReadTogether) {
  const MachineTime before = ports::host_now();
  const ClockPair pair = clock_pair();
  const MachineTime after = ports::host_now();
  EXPECT_TRUE(before <= pair.host && pair.host <= pair.now && pair.now <= after);
  // Two pairs of clock readings agree on a stamp, unless the clock is set or both readings are delayed.
  const ClockPair later = clock_pair();
  EXPECT_LT(std::abs((on_host(pair.realtime_ns, later) - pair.host).ns), 1'000'000);
}

}  // namespace
}  // namespace ttf::bus::socketcan
