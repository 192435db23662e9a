#include "schedules/analysis/can_load.h"

#include <gtest/gtest.h>

#include "bus/wire/can_timing.h"

namespace ttf::schedules::analysis {
namespace {

model::CanBus classic(std::int64_t rate = 1'000'000) {
  model::CanBus bus;
  bus.name = "classic";
  bus.nominal_bit_rate = bus.data_bit_rate = rate;
  return bus;
}

model::CanBus fast() {
  model::CanBus bus = classic();
  bus.name = "fast";
  bus.flexible_data_rate = true;
  bus.data_bit_rate = 5'000'000;
  return bus;
}

// Davis et al. 2007: 55 + 10 s bits for an 11-bit identifier.
TEST(CanFrames, ClassicWorstCaseIsTheKnownBound) {
  for (int s = 0; s <= 8; ++s) {
    EXPECT_EQ(can_worst_case(classic(), s), Duration::microseconds(55 + 10 * s));
    EXPECT_EQ(can_best_case(classic(), s), Duration::microseconds(47 + 8 * s));
  }
}

// 64 bytes: 17 + 13 bits and 3 stuff bits at 1 us; 5 + 512 + 32 bits and (518 - 1) / 4 = 129 stuff bits at 0.2 us.
TEST(CanFrames, FlexibleDataRateByHand) {
  EXPECT_EQ(can_worst_case(fast(), 64), Duration{33'000 + 678 * 200});
  EXPECT_EQ(can_best_case(fast(), 64), Duration{30'000 + 549 * 200});
  EXPECT_EQ(can_worst_case(fast(), 56), can_worst_case(fast(), 64));  // padded
}

// 0 0000 [1] 1111 [0] 000 00 [1] 1 0 1 at the nominal rate, then 0 1111 1 [0] 0000 [1] 1111 [0] ... at the data rate:
// one stuff bit is missing, because ESI and the length's code differ.
TEST(CanFrames, AllButOneOfTheStuffBitsAreReached) {
  const std::vector<std::byte> data(64, std::byte{0x87});
  EXPECT_EQ(bus::wire::can_frame_duration(fast(), 0x078, data), can_worst_case(fast(), 64) - Duration{200});
}

TEST(CanFrames, LengthsAreTheOnesThereAre) {
  int previous = -1;
  for (const int length : {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64}) {
    for (int bytes = previous + 1; bytes <= length; ++bytes) EXPECT_EQ(can_data_length(true, bytes), length);
    previous = length;
  }
  for (int bytes = 0; bytes <= 8; ++bytes) EXPECT_EQ(can_data_length(false, bytes), bytes);
  EXPECT_EQ(can_data_length(false, 9), std::nullopt);
  EXPECT_EQ(can_data_length(true, 65), std::nullopt);
  EXPECT_EQ(can_data_length(true, -1), std::nullopt);
}

TEST(CanFrames, RoundUpToWholeNanoseconds) {
  EXPECT_EQ(can_best_case(classic(300'000), 0), Duration{156'667});  // 47 / 300 kHz = 156'666.7 ns
}

// The duration of frames on the wire lies between the two.
TEST(CanFrames, BoundTheFramesOnTheWire) {
  for (const model::CanBus& bus : {classic(), fast()})
    for (const int length : {0, 1, 7, 8, 64}) {
      if (!can_data_length(bus.flexible_data_rate, length)) continue;
      for (const unsigned fill : {0x00u, 0xffu, 0x55u, 0x0fu, 0xf8u, 0x3cu, 0xc3u, 0x87u}) {
        const std::vector<std::byte> data(static_cast<std::size_t>(length), static_cast<std::byte>(fill));
        for (const std::uint32_t identifier : {0u, 0x7ffu, 0x555u, 0x7c1u, 0x078u}) {
          const Duration real = bus::wire::can_frame_duration(bus, identifier, data);
          EXPECT_LE(can_best_case(bus, length), real);
          EXPECT_GE(can_worst_case(bus, length), real);
        }
      }
    }
}

// The last bit of the end of frame and the three of the intermission lie behind a frame's acceptance.
TEST(CanFrames, AreAcceptedFourBitsBeforeTheBusIsIdle) {
  EXPECT_EQ(can_soonest_arrival(classic(), 8), Duration::microseconds(107));
  EXPECT_EQ(can_soonest_arrival(fast(), 64), Duration{26'000 + 549 * 200});
  EXPECT_EQ(can_soonest_arrival(classic(300'000), 0), Duration{143'334});  // 43 / 300 kHz = 143'333.3 ns
  EXPECT_EQ(can_after_acceptance(classic(300'000)), Duration{13'333});
}

// Three classic messages of one 8-byte frame each (135 us, accepted after 131 us), by hand.
TEST(CanResponse, BlockingAndHigherPriorities) {
  model::Cluster cluster;
  model::PduLayout layout;
  layout.fragment_bytes = 8;
  layout.max_elements = layout.elements_per_fragment = 1;
  cluster.pdus = {layout, layout, layout};
  model::CanBus bus = classic();
  bus.messages = {{PduId{0}, 10, NodeId{0}, Duration::milliseconds(1), 0},
                  {PduId{1}, 20, NodeId{0}, Duration::milliseconds(1), 0},
                  {PduId{2}, 30, NodeId{0}, Duration::milliseconds(1), 0}};
  EXPECT_DOUBLE_EQ(can_worst_load(cluster, bus), 3 * 0.135);
  EXPECT_EQ(can_worst_response(cluster, bus, bus.messages[0]), Duration::microseconds(266));  // one below, itself
  EXPECT_EQ(can_worst_response(cluster, bus, bus.messages[1]), Duration::microseconds(401));  // all three
  EXPECT_EQ(can_worst_response(cluster, bus, bus.messages[2]), Duration::microseconds(401));  // two above, itself
  // Other traffic takes half of the bus: a longest frame of it, too, and everything at half the speed.
  bus.other_load = 0.5;
  EXPECT_EQ(can_worst_response(cluster, bus, bus.messages[0]), Duration::microseconds(806));
  bus.other_load = 0.0;
  // Short periods: the highest comes every 200 us. It comes three times in 405 us, four times in 675 us, five
  // times in 810 us. 945 us have no more than five.
  bus.messages[0].shortest_period = Duration::microseconds(200);
  bus.messages[1].shortest_period = Duration::milliseconds(2);
  bus.messages[2].shortest_period = Duration::milliseconds(2);
  EXPECT_EQ(can_worst_response(cluster, bus, bus.messages[2]), Duration::microseconds(941));
  bus.messages[1].shortest_period = Duration::microseconds(300);
  EXPECT_EQ(can_worst_response(cluster, bus, bus.messages[2]), std::nullopt);
}

}  // namespace
}  // namespace ttf::schedules::analysis
