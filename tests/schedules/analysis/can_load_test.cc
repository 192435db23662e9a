#include "schedules/analysis/can_load.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bus/wire/can_timing.h"
#include "core/random.h"
#include "schedules/file/loader.h"
#include "tests/schedules/timing/task_set/running_buses.h"

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

// An older bound: frames of higher priority count that are queued until the last frame's end, and not only until its
// start. It holds for lists that are sent before the next one is queued.
Duration response_to_the_end(const model::Cluster& cluster, const model::CanBus& bus,
                             const model::CanMessage& message) {
  Duration lower{};
  for (const model::CanMessage& other : bus.messages)
    if (other.identifier > message.identifier)
      lower = std::max(lower, can_worst_case(bus, cluster.pdu(other.pdu).fragment_bytes));
  const Duration fixed = lower + can_list_worst_case(bus, cluster.pdu(message.pdu));
  for (Duration response = fixed;;) {
    Duration next = fixed;
    for (const model::CanMessage& other : bus.messages)
      if (other.identifier < message.identifier)
        next += can_list_worst_case(bus, cluster.pdu(other.pdu)) * (response.ns / other.shortest_period.ns + 1);
    if (next == response) return response - can_after_acceptance(bus);
    response = next;
  }
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
  // times in 810 us. 945 us have no more than five. But the last frame waits for those before its start alone: for three.
  bus.messages[0].shortest_period = Duration::microseconds(200);
  bus.messages[1].shortest_period = Duration::milliseconds(2);
  bus.messages[2].shortest_period = Duration::milliseconds(2);
  EXPECT_EQ(can_worst_response(cluster, bus, bus.messages[2]), Duration::microseconds(671));
  EXPECT_EQ(response_to_the_end(cluster, bus, bus.messages[2]), Duration::microseconds(941));
  bus.messages[1].shortest_period = Duration::microseconds(300);
  EXPECT_EQ(can_worst_response(cluster, bus, bus.messages[2]), std::nullopt);
}

// Lists on a CAN that runs: of one to four frames, with longer periods now and then, and with errors in every second
// set. No response is exceeded. Without errors it is no longer than that to the last frame's end.
struct DrawnCan {
  model::Cluster cluster;
  model::CanBus bus = classic();

  explicit DrawnCan(RandomStream& stream) {
    const std::int64_t count = stream.integer(2, 4);
    for (std::int64_t m = 0; m < count; ++m) {
      model::PduLayout layout;
      layout.fragment_bytes = static_cast<int>(stream.integer(1, 8));
      layout.elements_per_fragment = 1;
      layout.max_elements = static_cast<int>(stream.integer(1, 4));
      cluster.pdus.push_back(layout);
      bus.messages.push_back({static_cast<PduId>(m), static_cast<std::uint32_t>(10 * (m + 1)), NodeId{0},
                              Duration::microseconds(stream.integer(600, 3'000)), 0});
    }
  }

  Duration frame(std::size_t m) const { return can_worst_case(bus, cluster.pdus[m].fragment_bytes); }

  // All frames of a list wait from its queueing on.
  timing::task_set::BusJobs jobs(RandomStream& stream, bool at_once) const {
    timing::task_set::BusJobs found(bus.messages.size());
    for (std::size_t m = 0; m < found.size(); ++m) {
      std::int64_t at = at_once ? 1 : stream.integer(0, bus.messages[m].shortest_period.ns);
      while (at < 200'000'000) {
        for (int f = 0; f < cluster.pdus[m].max_fragments(); ++f) found[m].push_back({.arrival = at, .queued = at});
        at += bus.messages[m].shortest_period.ns + (at_once ? 0 : stream.integer(0, 3) / 3 * 100'000);
      }
    }
    return found;
  }
};

TEST(CanResponse, NoDrawnListIsLater) {
  int judged = 0, reached = 0, tighter = 0, struck = 0;
  for (std::uint32_t index = 0; index < 400; ++index) {
    RandomStream stream({.seed = 31, .purpose = Purpose::kTest, .index = index});
    const DrawnCan drawn(stream);
    if (can_worst_load(drawn.cluster, drawn.bus) > 0.75) continue;
    const bool errors = index % 2 == 1;
    const Duration apart = Duration::microseconds(stream.integer(4'000, 20'000));
    std::vector<std::int64_t> transmissions;
    for (std::size_t m = 0; m < drawn.bus.messages.size(); ++m) transmissions.push_back(drawn.frame(m).ns);
    for (int draw = 0; draw < 4; ++draw) {
      std::vector<std::int64_t> instants;
      for (std::int64_t at = stream.integer(0, apart.ns); errors && at < 400'000'000; at += apart.ns)
        instants.push_back(at);
      const auto longest = timing::task_set::longest_on_can(transmissions, drawn.jobs(stream, draw == 0), instants,
                                                            can_duration(drawn.bus, {31, 0}).ns);
      for (std::size_t m = 0; m < longest.size(); ++m) {
        const model::CanMessage& message = drawn.bus.messages[m];
        const auto bound =
            can_response_by_theory(drawn.cluster, drawn.bus, message, errors ? std::optional(apart) : std::nullopt);
        if (!bound) continue;
        ++judged;
        const Duration simulated = Duration{longest[m]} - can_after_acceptance(drawn.bus);
        ASSERT_LE(simulated, *bound) << "set " << index << ", message " << m;
        reached += simulated == *bound ? 1 : 0;
        const Duration to_the_end = response_to_the_end(drawn.cluster, drawn.bus, message);
        if (errors) {
          struck += simulated > can_response_by_theory(drawn.cluster, drawn.bus, message) ? 1 : 0;
        } else if (to_the_end + can_after_acceptance(drawn.bus) <= message.shortest_period) {
          ASSERT_LE(*bound, to_the_end) << "set " << index << ", message " << m;
          tighter += *bound < to_the_end ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(judged, 1000);
  EXPECT_GT(reached, 100);
  EXPECT_GT(tighter, 20);
  EXPECT_GT(struck, 20);
}

// All messages of the shipped clusters: both bounds agree, as no list is queued again while another one waits.
TEST(CanResponse, BoundsOfShippedClustersAgree) {
  int judged = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(TTF_SOURCE_DIR) + "/schedules")) {
    if (entry.path().extension() != ".yaml") continue;
    const model::Cluster cluster = file::load_cluster(entry.path().string());
    for (const model::CanBus& bus : cluster.can_buses)
      for (const model::CanMessage& message : bus.messages) {
        if (bus.other_load > 0.0) continue;
        EXPECT_EQ(can_worst_response(cluster, bus, message), response_to_the_end(cluster, bus, message))
            << entry.path() << " " << cluster.pdu(message.pdu).name;
        ++judged;
      }
  }
  EXPECT_GT(judged, 50);
}

}  // namespace
}  // namespace ttf::schedules::analysis
