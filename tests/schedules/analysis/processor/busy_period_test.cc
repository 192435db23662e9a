// The busy period alone: chains in, worst responses out. tests/schedules/analysis/responses_test.cc compares
// it with a queue.
#include "schedules/analysis/processor/busy_period.h"

#include <gtest/gtest.h>

namespace ttf::schedules::analysis::processor {
namespace {

constexpr std::int64_t kLimit = 1'000'000;

Chain by_message(std::int64_t work, std::int64_t period, std::int64_t jitter = 0) {
  return {work, ActivationBounds{{{period, jitter}}}};
}

// One every 100, of 40, with others of 30 beside it:
//
//   busy  |==40==|==30==|
TEST(BusyPeriod, IsTheWorkThatComesAtOnce) {
  const TaskChains set{{by_message(40, 100), by_message(30, 1'000)}, {}};
  const auto busy = busy_time(set, kLimit);
  ASSERT_TRUE(busy.has_value());
  EXPECT_EQ(*busy, 70);
  EXPECT_EQ(worst_chain_response(set, 0, *busy), 70);
  EXPECT_EQ(worst_chain_response(set, 1, *busy), 70);
}

// Two of a kind may come 10 apart, so the first busy period contains both; the second waits the longest.
//
//   activated  ^         ^10
//   busy       |==40==|==40==|==30==|
TEST(BusyPeriod, HasTheSecondOfAJitterInIt) {
  const TaskChains set{{by_message(40, 200, 190), by_message(30, 1'000)}, {}};
  EXPECT_EQ(busy_time(set, kLimit), 110);
  EXPECT_EQ(worst_chain_response(set, 0, 110), 100);
}

TEST(BusyPeriod, OfMoreWorkThanTimeHasNoEnd) {
  const TaskChains set{{by_message(60, 100), by_message(50, 100)}, {}};
  EXPECT_EQ(busy_time(set, kLimit), std::nullopt);
  EXPECT_EQ(busy_time({{by_message(60, 100)}, {}}, 59), std::nullopt) << "more than it may be";
}

// A chain whose newest activation was 25 ago has 25 less left. One that was activated longer ago than it
// takes is over.
TEST(BusyPeriod, IsShorterBehindWhatCameEarlier) {
  const TaskChains set{{by_message(40, 1'000), by_message(30, 1'000)}, {}};
  const std::int64_t ahead[] = {0, 25};
  EXPECT_EQ(worst_chain_response(set, 0, 70, ahead), 45);
  const std::int64_t long_ago[] = {0, 200};
  EXPECT_EQ(worst_chain_response(set, 0, 70, long_ago), 40);
}

// A sensor waits for the end of a task of 40, so that task runs once in 50, under any other load.
TEST(BusyPeriod, AFollowingSensorNeverOverloads) {
  const TaskChains set{{{40, ByFollower{.best = 40, .worst = 40, .pause = 10}}, by_message(30, 1'000)}, {}};
  const auto busy = busy_time(set, kLimit);
  ASSERT_TRUE(busy.has_value());
  EXPECT_EQ(worst_chain_response(set, 1, *busy), 70);
}

// Time brings 40 at 0 and 30 at 20, in rounds of 1000: the second waits for the first, and the first never
// waits.
TEST(BusyPeriod, OfTimedChainsIsExact) {
  const TaskChains set{{{40, ByTime{}}, {30, ByTime{}}}, TimedInstants({{20, 1}, {0, 0}}, 1'000, std::nullopt)};
  EXPECT_EQ(busy_time(set, kLimit), 70);
  EXPECT_EQ(worst_chain_response(set, 0, 70), 40);
  EXPECT_EQ(worst_chain_response(set, 1, 70), 50);
}

TEST(TimedInstants, GoOnInTheNextRoundAndBackInTheLast) {
  const TimedInstants instants({{100, 0}, {600, 1}}, 1'000, std::nullopt);
  const auto distances = [&](TimedInstants::Direction direction) {
    std::vector<std::int64_t> all;
    for (const auto& other : instants.within(1, 2'000, direction)) all.push_back(other.distance);
    return all;
  };
  EXPECT_EQ(distances(TimedInstants::kForward), (std::vector<std::int64_t>{0, 500, 1'000, 1'500, 2'000}));
  EXPECT_EQ(distances(TimedInstants::kBackward), (std::vector<std::int64_t>{0, 500, 1'000, 1'500, 2'000}));
  EXPECT_EQ(instants.within(0, 400, TimedInstants::kBackward).size(), 1u);
}

// 1 % by the rate, 1 us by the offset of every second cycle of 5 ms, 100 ns by the granularity, 1 ns by
// truncation.
TEST(TimedInstants, AreAsCloseAsCorrectionsMakeThem) {
  const ClockCorrections corrections{.cycle_ns = 5'000'000, .microticks = 200'000, .rate = 2'000, .offset_ns = 1'000};
  EXPECT_EQ(corrections.shortest(0), 0);
  EXPECT_EQ(corrections.shortest(1'000'000), 1'000'000 - 10'001 - 1'000 - 100);
  EXPECT_EQ(corrections.shortest(10'000'000), 10'000'000 - 100'001 - 2'000 - 100);
  EXPECT_EQ(corrections.shortest(500), 0);
  const TimedInstants slow({{0, 0}}, 320'000'000, ClockCorrections{5'000'000, 200'000, 150'000, 0});
  EXPECT_FALSE(slow.can_be_counted_on());
}

}  // namespace
}  // namespace ttf::schedules::analysis::processor
