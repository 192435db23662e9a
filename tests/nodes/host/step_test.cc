// Strobe latches, stamps and wrapping sequence numbers, and the content of an output list.
#include "nodes/host/step.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "nodes/fusion/fusion_host.h"
#include "schedules/file/loader.h"
#include "tests/bus/layouts.h"

namespace ttf::nodes::host {
namespace {

constexpr int kAllBits = 32;

TEST(StrobeLatch, HasTheNewestSixteenMeasurements) {
  StrobeLatch latch;
  EXPECT_FALSE(latch.find(0, kAllBits)) << "nothing yet, not even number 0";
  for (std::uint32_t k = 0; k < 40; ++k) {
    latch.strobe(k, GlobalTime{1000 + k});
    for (std::uint32_t asked = 0; asked < 60; ++asked) {
      const auto strobe = latch.find(asked, kAllBits);
      ASSERT_EQ(strobe.has_value(), asked <= k && asked + 16 > k) << "asked for " << asked << " after " << k;
      if (strobe) {
        EXPECT_EQ(strobe->at.ns, 1000 + asked);
        EXPECT_EQ(strobe->sequence, asked);
      }
    }
  }
}

TEST(StrobeLatch, ALostStrobeLeavesAGapNotANeighboursTime) {
  StrobeLatch latch;
  latch.strobe(3, GlobalTime{30});
  latch.strobe(5, GlobalTime{50});
  EXPECT_FALSE(latch.find(4, kAllBits));
  EXPECT_FALSE(latch.find(19, kAllBits)) << "the same place in the latch as 3";
  EXPECT_EQ(latch.find(5, kAllBits)->at.ns, 50);
}

// A host that started late has missed the number's wrap; a restarted device has gone back. In both cases the
// list's low bits identify the measurement, with the device's number.
TEST(StrobeLatch, ListsAreRecognisedByTheBitsTheBusCarries) {
  StrobeLatch latch;
  for (std::uint32_t k = 4090; k < 4100; ++k) latch.strobe(k, GlobalTime{k});
  EXPECT_EQ(latch.find(4097 % 4096, 12)->sequence, 4097u);
  EXPECT_EQ(latch.find(2 * 4096 + 4090, 12)->sequence, 4090u);
  EXPECT_FALSE(latch.find(4100 % 4096, 12));
  for (std::uint32_t k = 0; k < 3; ++k) latch.strobe(k, GlobalTime{10'000 + k});
  EXPECT_EQ(latch.find(4098, 12)->at.ns, 10'002) << "the newest of those it may be";
}

schedules::model::PduLayout stamped(int bits) {
  schedules::model::PduLayout layout = bus::list_layout(8, 10, 3);
  layout.header.push_back(bus::signal("timestamp", bits));
  bus::derive(layout.header, layout.header_bits);
  layout.header_bits = (layout.header_bits + 7) / 8 * 8;
  layout.fragment_bytes = (layout.header_bits + 3 * layout.element_bits) / 8;
  return layout;
}

// Longer than the signal's wrap: sender and reader count the same rounds.
constexpr Duration kSameRounds{std::int64_t{1} << 50};

// The low bits give any instant to the microsecond, from any instant within half a wrap.
TEST(TimeStamp, UnwrapsToTheNearestInstant) {
  RandomStream draw({.seed = 9});
  for (const int bits : {16, 24, 32}) {
    const schedules::model::PduLayout layout = stamped(bits);
    const std::int64_t half = (std::int64_t{1} << bits) / 2;
    Output out("out", PduId{0}, layout);
    for (int k = 0; k < 2000; ++k) {
      const std::int64_t us = draw.integer(-5 * half, 50 * half);
      out.begin(0, 1, GlobalTime{us * 1000});
      const std::int64_t off = k == 0 ? half - 1 : k == 1 ? -half + 1 : draw.integer(-half + 1, half - 1);
      ASSERT_EQ(time_stamp(layout, out.view(), GlobalTime{(us + off) * 1000}, kSameRounds).ns, us * 1000)
          << bits << " bits, " << us << " " << off;
    }
  }
}

TEST(TimeStamp, RoundsToTheNearestMicrosecondAlsoBeforeTheStart) {
  const schedules::model::PduLayout layout = stamped(32);
  Output out("out", PduId{0}, layout);
  for (const auto& [ns, us] : {std::pair{1499, 1}, {1500, 2}, {-499, 0}, {-501, -1}, {-1501, -2}}) {
    out.begin(0, 1, GlobalTime{ns});
    EXPECT_EQ(time_stamp(layout, out.view(), GlobalTime{0}, kSameRounds).ns, us * 1000) << ns;
  }
}

// Sender and reader have restarted any number of times: they count different rounds. A stamp is resolved on
// the reader's count, from any instant within half a round.
TEST(TimeStamp, IsUnderstoodModuloARoundOfTheCycleCounter) {
  RandomStream draw({.seed = 10});
  const schedules::model::PduLayout layout = stamped(32);
  Output out("out", PduId{0}, layout);
  for (const std::int64_t cycle_us : {1'000, 2'000, 5'000, 16'000}) {
    const std::int64_t round_us = 64 * cycle_us, half = round_us / 2;
    for (int k = 0; k < 2000; ++k) {
      const std::int64_t sent_us = draw.integer(0, 3'600'000'000);
      const std::int64_t rounds = draw.integer(-sent_us / round_us, 3'600'000'000 / round_us);
      const std::int64_t meant_us = sent_us + rounds * round_us;
      const std::int64_t off = k == 0 ? half - 1 : k == 1 ? -half + 1 : draw.integer(-half + 1, half - 1);
      out.begin(0, 1, GlobalTime{sent_us * 1000});
      ASSERT_EQ(
          time_stamp(layout, out.view(), GlobalTime{(meant_us + off) * 1000}, Duration::microseconds(round_us)).ns,
          meant_us * 1000)
          << cycle_us << " " << sent_us << " " << rounds << " " << off;
    }
  }
}

// Sequence numbers keep their low bits on the bus; the list in the CNI counts on.
TEST(Output, SequenceNumbersWrapInTheHeaderOnly) {
  const schedules::model::PduLayout layout = bus::list_layout(4, 10, 3);
  Output out("out", PduId{0}, layout);
  bus::cni::IncomingList incoming(layout);
  for (std::uint32_t k = 0; k < 100; ++k) {
    out.begin(k, 5, GlobalTime{});
    EXPECT_EQ(out.view().sequence, k);
    for (int f = 0; f < out.view().fragments; ++f)
      incoming.arrive(out.view().bytes.subspan(static_cast<std::size_t>(f * layout.fragment_bytes),
                                               static_cast<std::size_t>(layout.fragment_bytes)));
    ASSERT_TRUE(incoming.latest().has_value());
    EXPECT_EQ(incoming.latest()->sequence, k) << "unwrapped";
  }
}

TEST(Output, HoldsWhatWasSetAndNothingOfTheListBefore) {
  const schedules::model::PduLayout layout = bus::list_layout();
  Output out("out", PduId{0}, layout);
  out.begin(1, 10, GlobalTime{});
  for (int i = 0; i < 10; ++i) out.set(i, 0, 100.0 + i);
  EXPECT_EQ(element_count(layout, out.view()), 10);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(element_value(layout, out.view(), i, 0), 100.0 + i);
  EXPECT_EQ(out.view().fragments, 4);
  out.begin(2, 4, GlobalTime{});
  EXPECT_EQ(element_count(layout, out.view()), 4);
  EXPECT_EQ(out.view().fragments, 2);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(element_value(layout, out.view(), i, 0), 0.0);
  out.begin(3, 0, GlobalTime{});
  EXPECT_EQ(out.view().fragments, 1) << "an empty list is a message too";
}

// Counts of rounds in arriving lists: only some have a known age.
TEST(RoundsBelieved, AnotherCountTakesTwoListsInARow) {
  fusion::RoundsBelieved rounds;
  for (const auto& [count, believed] : {std::pair{0, true},
                                        {0, true},
                                        {5, false},
                                        {0, true},
                                        {5, false},
                                        {5, true},
                                        {5, true},
                                        {-2, false},
                                        {7, false},
                                        {-2, false},
                                        {-2, true},
                                        {5, false},
                                        {-2, true}})
    EXPECT_EQ(rounds.believed(count), believed) << count;
}

TEST(Output, SaturatesAndCounts) {
  const schedules::model::PduLayout layout = bus::list_layout();
  Output out("out", PduId{0}, layout);
  out.begin(1, 3, GlobalTime{});
  out.set(0, 0, 1e9);
  out.set(1, 0, -3.0);
  out.set(2, 0, 65535.0);
  EXPECT_EQ(element_value(layout, out.view(), 0, 0), 65535.0);
  EXPECT_EQ(element_value(layout, out.view(), 1, 0), 0.0);
  EXPECT_EQ(out.take_saturated(), 2);
  EXPECT_EQ(out.take_saturated(), 0);
}

}  // namespace
}  // namespace ttf::nodes::host
