#include "timebase/clock_sync.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/random.h"

namespace ttf::timebase {
namespace {

std::optional<int> midpoint(std::vector<int> values) { return fault_tolerant_midpoint(values); }

TEST(FaultTolerantMidpoint, OfNothingIsNothing) { EXPECT_EQ(midpoint({}), std::nullopt); }

struct Row {
  std::vector<int> values;
  int result;
};

// Table of the specification: k = 0 for 1-2 values, 1 for 3-7, 2 for 8-15.
TEST(FaultTolerantMidpoint, DropsTheExtremesByCount) {
  const Row rows[] = {
      {{6}, 6},
      {{6, 10}, 8},
      {{-100, 4, 100}, 4},
      {{-100, 4, 6, 100}, 5},
      {{15, 13, -6, 5}, 9},
      {{1000, 1, 2, 3, 5, -1000, 7}, 4},                          // seven: one at each end
      {{1000, 999, 1, 2, 4, 8, -999, -1000}, 4},                  // eight: two at each end
      {{9, 8, 7, 6, 5, 4, 3, 2, 1, 0, -1, -2, -3, -4, -400}, 2},  // fifteen
  };
  for (const Row& row : rows) EXPECT_EQ(midpoint(row.values), row.result) << row.values.size() << " values";
}

// It is the midpoint of the remaining extremes, not the mean of all.
TEST(FaultTolerantMidpoint, IsNoMean) { EXPECT_EQ(midpoint({-50, 0, 0, 0, 10, 50}), 5); }

TEST(FaultTolerantMidpoint, RoundsTowardsZero) {
  EXPECT_EQ(midpoint({3, 4}), 3);
  EXPECT_EQ(midpoint({-3, -4}), -3);
  EXPECT_EQ(midpoint({-1, 0}), 0);
  EXPECT_EQ(midpoint({0, 1}), 0);
  EXPECT_EQ(midpoint({-8, 1, 2, 90}), 1);
}

// With any values of k faulty clocks, the result stays within the range of the others.
TEST(FaultTolerantMidpoint, StaysWithinTheFaultlessValues) {
  RandomStream stream({3, 0, Purpose::kTest, 1, 0});
  for (int run = 0; run < 5000; ++run) {
    const auto count = static_cast<int>(stream.integer(3, kMaxSyncNodes));
    const int faulty = count > 7 ? 2 : 1;
    std::vector<int> good, all;
    for (int i = 0; i < count - faulty; ++i) good.push_back(static_cast<int>(stream.integer(-200, 200)));
    all = good;
    for (int i = 0; i < faulty; ++i) all.push_back(static_cast<int>(stream.integer(-100'000, 100'000)));
    const auto result = midpoint(all);
    ASSERT_TRUE(result);
    ASSERT_GE(*result, *std::min_element(good.begin(), good.end()));
    ASSERT_LE(*result, *std::max_element(good.begin(), good.end()));
  }
}

TEST(OffsetCorrection, TakesTheSmallerChannelOfEachNode) {
  const SyncDeviation deviations[] = {{1, 10, 4}, {2, std::nullopt, 8}};
  EXPECT_EQ(offset_correction(deviations, 100).value, 6);
  const SyncDeviation below[] = {{1, -10, 4}};
  EXPECT_EQ(offset_correction(below, 100).value, -10);
}

TEST(OffsetCorrection, LimitsAndSaysSo) {
  const SyncDeviation late[] = {{1, 500, 500}}, early[] = {{1, -500, -500}}, just[] = {{1, 400, 400}};
  const Correction up = offset_correction(late, 400);
  EXPECT_EQ(up.value, 400);
  EXPECT_TRUE(up.limit_reached);
  const Correction down = offset_correction(early, 400);
  EXPECT_EQ(down.value, -400);
  EXPECT_TRUE(down.limit_reached);
  EXPECT_FALSE(offset_correction(just, 400).limit_reached);
}

TEST(OffsetCorrection, WithoutAnyFrameIsZeroAndMissing) {
  const SyncDeviation unseen[] = {{1, std::nullopt, std::nullopt}};
  for (const Correction& correction : {offset_correction({}, 100), offset_correction(unseen, 100)}) {
    EXPECT_EQ(correction.value, 0);
    EXPECT_TRUE(correction.missing);
    EXPECT_FALSE(correction.limit_reached);
  }
}

SyncMeasurements pairs(std::vector<SyncDeviation> even, std::vector<SyncDeviation> odd) {
  SyncMeasurements measured;
  for (const SyncDeviation& d : even) measured.even[static_cast<std::size_t>(measured.even_count++)] = d;
  for (const SyncDeviation& d : odd) measured.odd[static_cast<std::size_t>(measured.odd_count++)] = d;
  return measured;
}

TEST(RateCorrection, IsOddMinusEvenOfTheSameFrame) {
  // Neither frame 3 nor frame 9 has a partner; the order of arrival does not matter.
  const auto measured = pairs({{1, 10, 12}, {2, -5, -5}, {3, 900, 900}}, {{9, -900, -900}, {2, 5, 5}, {1, 30, 32}});
  EXPECT_EQ(rate_correction(measured, 0, 0, 1000).value, 15);  // (20 + 10) / 2
}

TEST(RateCorrection, AveragesChannelsValidInBoth) {
  EXPECT_EQ(rate_correction(pairs({{1, 0, 0}}, {{1, 10, 20}}), 0, 0, 1000).value, 15);
  EXPECT_EQ(rate_correction(pairs({{1, 0, std::nullopt}}, {{1, 10, 20}}), 0, 0, 1000).value, 10);
  const Correction none = rate_correction(pairs({{1, 0, std::nullopt}}, {{1, std::nullopt, 20}}), 7, 0, 1000);
  EXPECT_TRUE(none.missing);
  EXPECT_EQ(none.value, 7);
}

TEST(RateCorrection, MissingKeepsThePreviousTermUndamped) {
  const Correction correction = rate_correction({}, -33, 2, 1000);
  EXPECT_EQ(correction.value, -33);
  EXPECT_TRUE(correction.missing);
}

TEST(RateCorrection, DampsTowardsZero) {
  const auto rate = [](int previous, int measured) {
    return rate_correction(pairs({{1, 0, 0}}, {{1, measured, measured}}), previous, 3, 1000).value;
  };
  EXPECT_EQ(rate(10, 5), 12);
  EXPECT_EQ(rate(-10, -5), -12);
  EXPECT_EQ(rate(0, 4), 1);
  EXPECT_EQ(rate(0, -4), -1);
  for (int within = -3; within <= 3; ++within) EXPECT_EQ(rate(0, within), 0) << within;
}

TEST(RateCorrection, LimitsAfterDamping) {
  const auto rate = [](int measured) {
    return rate_correction(pairs({{1, 0, 0}}, {{1, measured, measured}}), 0, 2, 100);
  };
  EXPECT_EQ(rate(102).value, 100);
  EXPECT_FALSE(rate(102).limit_reached);
  EXPECT_EQ(rate(103).value, 100);
  EXPECT_TRUE(rate(103).limit_reached);
  EXPECT_EQ(rate(-500).value, -100);
  EXPECT_TRUE(rate(-500).limit_reached);
}

TEST(RateCorrection, TakesFifteenNodes) {
  std::vector<SyncDeviation> even, odd;
  for (int id = 1; id <= kMaxSyncNodes; ++id) even.push_back({id, 0, 0}), odd.push_back({id, id, id});
  EXPECT_EQ(rate_correction(pairs(even, odd), 0, 0, 100).value, 8);
}

}  // namespace
}  // namespace ttf::timebase
