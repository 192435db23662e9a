// Where arrivals are put on a node's clock, against hand-made frames at known microticks.
#include "nodes/runner/arrival_window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "schedules/file/loader.h"
#include "tests/support/allocation_counter.h"

namespace ttf::nodes::runner {
namespace {

using bus::ports::LiveArrival;
using schedules::model::Channel;

struct Reported final : ArrivalEvents {
  struct Missed {
    std::int64_t cycle;
    int slot;
    std::int64_t behind;
  };
  std::vector<std::int64_t> behind;
  std::vector<Missed> missed;
  std::vector<std::uint32_t> lost_counts;
  Reported() {
    behind.reserve(64);
    missed.reserve(64);
    lost_counts.reserve(64);
  }
  void arrived(Microticks b) override { behind.push_back(b.value); }
  void missed_window(std::int64_t cycle, int slot, Channel, Microticks b) override {
    missed.push_back({cycle, slot, b.value});
  }
  void lost(std::int64_t, int, Channel, std::uint32_t count) override { lost_counts.push_back(count); }
};

// The feature node of the paper's cluster. Other nodes' key slots are 1 to 4, slot 6 carries the gateway's
// list. A macrotick has 40 microticks, a cycle 200,000; it begins at 1,000,000.
class ArrivalWindowTest : public testing::Test {
 protected:
  static constexpr std::int64_t kStart = 1'000'000;
  ArrivalWindowTest() : clock_({5000, 1'000'000, 200'000, 4900}, Microticks{kStart}, 0, kCycle) {}

  std::int64_t action_point(int slot) const { return clock_.start_of(Macroticks{(slot - 1) * 84 + 7}).value; }
  static Microticks frame_length() { return Microticks{652 * 4}; }  // bits of 100 ns, microticks of 25 ns

  void arrive(int slot, std::int64_t at, bool sync, std::int64_t cycle = kCycle, std::optional<std::int64_t> late = {},
              bool clock = true) {
    bus::wire::FrameHeader header;
    header.frame_id = static_cast<std::uint16_t>(slot);
    header.cycle = static_cast<std::uint8_t>(cycle % 64);
    header.sync = header.startup = sync;
    const std::array<std::byte, 56> payload{};
    std::array<std::byte, bus::wire::kMaxFrameBytes> bytes;
    const std::size_t size = bus::wire::encode_frame(header, Channel::kA, payload, bytes);
    LiveArrival arrival;
    arrival.signal.slot = slot;
    arrival.signal.bytes = std::span<const std::byte>(bytes).first(size);
    window_.arrive(arrival, Microticks{at}, late ? std::optional(Microticks{*late}) : std::nullopt, {},
                   clock ? &clock_ : nullptr);
  }
  void follow_up(int slot, std::int64_t late) {
    LiveArrival arrival;
    arrival.kind = LiveArrival::Kind::kFollowUp;
    arrival.signal.slot = slot;
    arrival.cycle_counter = kCycle % 64;
    window_.arrive(arrival, {}, Microticks{late}, {}, &clock_);
  }
  void arrive_and_take(int slot, std::int64_t cycle) {
    arrive(slot, action_point(slot), false, cycle);
    EXPECT_TRUE(take(clock_.cycle_end().value));
  }
  std::optional<ArrivalWindow::Due> take(std::int64_t now) { return window_.take(Microticks{now}, &clock_); }

  static constexpr std::int64_t kCycle = 130;  // its counter is 2
  static constexpr std::int64_t kCompensation = 50;
  const schedules::model::Cluster cluster_ =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_synchronised.yaml");
  timebase::CycleClock clock_;
  Reported reported_;
  ArrivalWindow window_{cluster_, *cluster_.find_node("feature"), {Microticks{4000}, Microticks{16'000}}, reported_};
};

TEST_F(ArrivalWindowTest, AFrameWithinItsWindowIsHandedOverAtItsActionPoint) {
  for (const std::int64_t behind : {-4000, -1, 0, 1, 2000, 16'000}) {
    arrive(6, action_point(6) + behind, false);
    const std::int64_t end = action_point(6) + kCompensation + frame_length().value;
    EXPECT_EQ(window_.next().value, action_point(6) + behind);
    const std::int64_t there = std::max(end, action_point(6) + behind);
    EXPECT_FALSE(take(there - 1)) << "before it has ended, or come";
    EXPECT_EQ(window_.next().value, there);
    const auto due = take(there);
    ASSERT_TRUE(due);
    EXPECT_EQ(due->reception.start.value, action_point(6) + kCompensation);
    EXPECT_EQ(due->reception.end.value, end);
    EXPECT_EQ(due->reception.frame.header.frame_id, 6);
    EXPECT_EQ(due->reception.frame.error, bus::wire::FrameError::kNone);
    EXPECT_EQ(reported_.behind.back(), behind);
  }
  EXPECT_TRUE(reported_.missed.empty());
}

TEST_F(ArrivalWindowTest, AFrameOutsideItsWindowIsReportedAndNotUsed) {
  arrive(6, action_point(6) + 16'001, false);
  arrive(6, action_point(6) - 4001, false);
  EXPECT_FALSE(take(kStart + 1'000'000));
  ASSERT_EQ(reported_.missed.size(), 2u);
  EXPECT_EQ(reported_.missed[0].behind, -4001);
  EXPECT_EQ(reported_.missed[1].behind, 16'001);
  EXPECT_EQ(reported_.missed[0].slot, 6);
  EXPECT_EQ(reported_.missed[0].cycle, kCycle);
  EXPECT_EQ(window_.held(), 0u);
}

TEST_F(ArrivalWindowTest, ASyncFrameIsWhereItWouldHaveBeenHadItsSenderBeenInTime) {
  for (const std::int64_t deviation : {-200, -3, 0, 7, 200}) {
    arrive(1, action_point(1) + deviation + 3000, true, kCycle, 3000);
    const auto due = take(kStart + 100'000);
    ASSERT_TRUE(due);
    EXPECT_EQ(due->reception.start.value, action_point(1) + kCompensation + deviation);
  }
}

TEST_F(ArrivalWindowTest, ASyncFrameIsNeverPutBeyondWhatFlexRayAllows) {
  arrive(1, action_point(1) + 5000, true, kCycle, 0);
  const auto due = take(kStart + 100'000);
  ASSERT_TRUE(due);
  // The action point lies 7 macroticks in. One is kept, and an eighth of the others.
  EXPECT_EQ(due->reception.start.value, action_point(1) + kCompensation + 6 * 40 - 30);
}

// Rates are measured even between clocks far apart, as long as there is room.
//
//   deviation in the even cycle    5000   -3900    5000   100    5000   210    none
//   in the odd one so much more      20     -20     -70    20      50    20    5000
TEST_F(ArrivalWindowTest, TheDifferenceOfADoubleCyclesDeviationsIsKept) {
  static constexpr std::int64_t kMost = 6 * 40 - 30;
  struct Case {
    std::int64_t even, more, put_even, put_odd;
  };
  std::int64_t cycle = kCycle;
  const auto put = [&](std::int64_t deviation) {
    clock_ = timebase::CycleClock({5000, 1'000'000, 200'000, 4900}, Microticks{kStart}, 0, cycle);
    arrive(1, action_point(1) + deviation, true, cycle, 0);
    ++cycle;
    const auto due = take(kStart + 100'000);
    return due ? due->reception.start.value - action_point(1) - kCompensation : INT64_MAX;
  };
  for (const Case& c : {Case{5000, 20, kMost, kMost + 20},
                        {-3900, -20, -kMost, -kMost - 20},
                        {5000, -70, kMost, kMost - 70},
                        {100, 20, 100, 120},
                        {5000, 50, kMost, 240},
                        {kMost, 20, kMost, kMost + 20}}) {
    EXPECT_EQ(put(c.even), c.put_even) << c.even;
    EXPECT_EQ(put(c.even + c.more), c.put_odd) << c.even << ' ' << c.more;
  }
  ++cycle;  // an even one that never came
  EXPECT_EQ(put(5000), kMost);
}

TEST_F(ArrivalWindowTest, ASyncFrameWaitsForItsFollowUp) {
  arrive(1, action_point(1) + 2000, true);
  EXPECT_FALSE(take(action_point(1) + 2000 + 15'000));
  follow_up(2, 1999);  // for another slot
  EXPECT_FALSE(take(action_point(1) + 2000 + 15'000));
  follow_up(1, 1990);
  const auto due = take(action_point(1) + 2000 + 15'000);
  ASSERT_TRUE(due);
  EXPECT_EQ(due->reception.start.value, action_point(1) + kCompensation + 10);
}

TEST_F(ArrivalWindowTest, WithoutFollowUpItSaysNothingOfTheClock) {
  arrive(1, action_point(1) + 2000, true);
  const auto due = take(action_point(1) + 2000 + 16'000);
  ASSERT_TRUE(due);
  EXPECT_EQ(due->reception.start.value, action_point(1) + kCompensation);
}

TEST_F(ArrivalWindowTest, AFrameOfTheNextCycleWaitsForIt) {
  arrive(1, kStart + 200'000 + 7 * 40 - 1000, true, kCycle + 1, 0);
  EXPECT_FALSE(take(kStart + 200'000));
  clock_.next_cycle(0);
  EXPECT_FALSE(take(kStart + 200'001)) << "not before it would have ended";
  const auto due = take(kStart + 300'000);
  ASSERT_TRUE(due);
  EXPECT_EQ(due->reception.start.value, action_point(1) + kCompensation - 6 * 40 + 30);
  EXPECT_TRUE(reported_.missed.empty());
}

TEST_F(ArrivalWindowTest, AFrameOfTheCycleBeforeIsLate) {
  arrive(6, action_point(6) - 200'000 + 300'000, false, kCycle - 1);
  EXPECT_FALSE(take(kStart + 1'000'000));
  ASSERT_EQ(reported_.missed.size(), 1u);
  EXPECT_EQ(reported_.missed[0].behind, 300'000);
  EXPECT_EQ(reported_.missed[0].cycle, kCycle - 1);
}

TEST_F(ArrivalWindowTest, AMissingFrameIsReportedByTheNextOfItsSlot) {
  arrive_and_take(6, kCycle);
  for (int i = 0; i < 3; ++i) clock_.next_cycle(0);
  arrive_and_take(6, kCycle + 3);
  EXPECT_EQ(reported_.lost_counts, std::vector<std::uint32_t>{2});
  clock_.next_cycle(0);
  arrive_and_take(6, kCycle + 4);
  EXPECT_EQ(reported_.lost_counts.size(), 1u);
}

// A stopped process finds frames of an earlier round whose cycle counter equals the present one.
TEST_F(ArrivalWindowTest, AFrameOfTheRoundBeforeIsNotTakenForOneOfThisCycle) {
  arrive(6, action_point(6) - 64 * 200'000, false, kCycle - 64);
  EXPECT_FALSE(take(kStart + 1'000'000));
  ASSERT_EQ(reported_.missed.size(), 1u);
  EXPECT_EQ(reported_.missed[0].cycle, kCycle - 64);
}

// The image is sent in one cycle of eight.
TEST_F(ArrivalWindowTest, ASlotIsMissedOnlyInCyclesThatItIsSentIn) {
  while (clock_.cycle() % 8 != 1) clock_.next_cycle(0);
  arrive_and_take(22, clock_.cycle());
  for (int i = 0; i < 24; ++i) clock_.next_cycle(0);
  arrive_and_take(22, clock_.cycle());
  EXPECT_EQ(reported_.lost_counts, std::vector<std::uint32_t>{2});
}

TEST_F(ArrivalWindowTest, ANodeThatWasAwayForLongHasLostNothing) {
  arrive_and_take(6, kCycle);
  for (int i = 0; i < 65; ++i) clock_.next_cycle(0);
  arrive_and_take(6, kCycle + 65);
  EXPECT_TRUE(reported_.lost_counts.empty());
}

TEST_F(ArrivalWindowTest, WithoutAClockAFrameKeepsItsInstant) {
  arrive(1, 5'000'123, true, kCycle, 23, false);
  const auto due = window_.take(Microticks{5'100'000}, nullptr);
  ASSERT_TRUE(due);
  EXPECT_EQ(due->reception.start.value, 5'000'100);
  EXPECT_EQ(due->reception.end.value, 5'000'100 + frame_length().value);
}

// A delayed process finds frames of cycles that its node has yet to reach.
TEST_F(ArrivalWindowTest, AFrameThatCameDuringADelayIsPlacedWhenItsCycleComes) {
  for (int ahead = 0; ahead < 5; ++ahead) arrive(6, action_point(6) + ahead * 200'000 + 900, false, kCycle + ahead);
  for (int ahead = 0; ahead < 5; ++ahead) {
    const auto due = take(clock_.cycle_end().value);
    ASSERT_TRUE(due) << ahead;
    EXPECT_EQ(due->reception.start.value, action_point(6) + kCompensation);
    EXPECT_FALSE(take(clock_.cycle_end().value));
    clock_.next_cycle(0);
  }
  EXPECT_TRUE(reported_.missed.empty());
}

// A clock derived for a past cycle, which does not go on: frames do not wait for it.
TEST_F(ArrivalWindowTest, AFrameOfTheNextCycleDoesNotWaitForAClockThatStandsStill) {
  arrive(6, action_point(6) + 200'000, false, kCycle + 1);
  const auto due = take(kStart + 900'000);
  ASSERT_TRUE(due);
  EXPECT_EQ(due->reception.start.value, action_point(6) + 200'000);
}

TEST_F(ArrivalWindowTest, AFrameThatIsHandedOverTooLateForItsCycleIsReported) {
  arrive(6, action_point(6) + 100, false, kCycle + 20);  // kept unchanged
  for (int i = 0; i < 2; ++i) clock_.next_cycle(0);
  EXPECT_FALSE(take(clock_.cycle_start().value + 10));
  EXPECT_EQ(reported_.missed.size(), 1u);
}

TEST_F(ArrivalWindowTest, AnAbsurdCycleIsTheControllersToJudge) {
  arrive(6, action_point(6) + 9, false, kCycle + 20);
  const auto due = take(kStart + 1'000'000);
  ASSERT_TRUE(due);
  EXPECT_EQ(due->reception.start.value, action_point(6) + 9);
}

TEST_F(ArrivalWindowTest, HandsOverInTheOrderOfInstants) {
  arrive(6, action_point(6) + 3000, false);
  arrive(1, action_point(1) + 9000, true, kCycle, 9000);
  LiveArrival can;
  can.kind = LiveArrival::Kind::kCan;
  can.can_bus = 1;
  const std::array data{std::byte{1}, std::byte{2}};
  can.can = {77, true, data};
  window_.arrive(can, Microticks{action_point(1) + 100'000}, {}, {}, &clock_);
  std::vector<std::int64_t> order;
  while (const auto due = take(kStart + 1'000'000)) {
    order.push_back(due->kind == LiveArrival::Kind::kCan ? 0 : due->reception.frame.header.frame_id);
    if (due->kind != LiveArrival::Kind::kCan) continue;
    EXPECT_EQ(due->can.identifier, 77u);
    EXPECT_EQ(due->can_bus, 1u);
    EXPECT_EQ(due->can.data.size(), 2u);
    EXPECT_EQ(due->at.value, action_point(1) + 100'000);
  }
  EXPECT_EQ(order, (std::vector<std::int64_t>{1, 6, 0}));
}

TEST_F(ArrivalWindowTest, NothingAllocatesAfterTheStart) {
  const std::int64_t before = support::allocations();
  for (int round = 0; round < 3; ++round) {
    for (const int slot : {1, 6}) arrive(slot, action_point(slot) + 100, slot == 1, clock_.cycle());
    follow_up(1, 90);
    while (take(clock_.cycle_end().value)) {
    }
    arrive(6, action_point(6) + 17'000, false, clock_.cycle());
    (void)take(clock_.cycle_end().value);
    clock_.next_cycle(0);
  }
  EXPECT_EQ(support::allocations(), before);
}

TEST_F(ArrivalWindowTest, ASymbolIsCarriedUntilItEnds) {
  LiveArrival symbol;
  symbol.signal.signal = bus::ports::Signal::kCas;
  symbol.signal.channel = Channel::kB;
  window_.arrive(symbol, Microticks{500}, {}, Microticks{400}, nullptr);
  EXPECT_TRUE(window_.carrier(Channel::kB, Microticks{899}));
  EXPECT_FALSE(window_.carrier(Channel::kA, Microticks{899}));
  EXPECT_FALSE(window_.carrier(Channel::kB, Microticks{900}));
  const auto due = window_.take(Microticks{900}, nullptr);
  ASSERT_TRUE(due);
  EXPECT_EQ(due->reception.signal, bus::ports::Signal::kCas);
  EXPECT_EQ(due->reception.start.value, 500);
}

TEST_F(ArrivalWindowTest, FramesWithoutRoomAreCounted) {
  for (std::size_t i = 0; i < ArrivalWindow::kMost + 5; ++i) arrive(6, action_point(6), false);
  EXPECT_EQ(window_.held(), ArrivalWindow::kMost);
  EXPECT_EQ(window_.dropped(), 5u);
}

}  // namespace
}  // namespace ttf::nodes::runner
