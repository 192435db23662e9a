#include "experiments/results/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "experiments/results/share.h"

namespace ttf::experiments::results {
namespace {

TEST(Moments, AreThoseOfTheTextbook) {
  Moments moments;
  EXPECT_TRUE(std::isnan(moments.mean()));
  for (const double x : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) moments.add(x);
  moments.add(std::nan(""));
  EXPECT_EQ(moments.count(), 8u);
  EXPECT_DOUBLE_EQ(moments.mean(), 5.0);
  EXPECT_DOUBLE_EQ(moments.variance(), 32.0 / 7.0);
}

// A large mean does not reduce the variance's precision.
TEST(Moments, LargeNumbersCancelNothing) {
  Moments moments;
  for (const double x : {1e9 + 4.0, 1e9 + 7.0, 1e9 + 13.0, 1e9 + 16.0}) moments.add(x);
  EXPECT_DOUBLE_EQ(moments.variance(), 30.0);
}

// Student's t, 97.5 %: 12.7062 of 1 degree, 2.7764 of 4, 2.0423 of 30 (the tables every textbook has).
TEST(Interval, IsStudents) {
  const auto width = [](int samples) {
    Moments moments;
    for (int i = 0; i < samples; ++i) moments.add(i % 2 == 0 ? 1.0 : -1.0);
    const Interval interval = interval_of(moments, 0.95);
    return interval.half_width / std::sqrt(moments.variance() / samples);
  };
  EXPECT_NEAR(width(2), 12.7062, 5e-5);
  EXPECT_NEAR(width(5), 2.7764, 5e-5);
  EXPECT_NEAR(width(31), 2.0423, 5e-5);
}

TEST(Interval, OfOneSampleIsNone) {
  Moments moments;
  moments.add(3.0);
  const Interval interval = interval_of(moments, 0.95);
  EXPECT_EQ(interval.mean, 3.0);
  EXPECT_TRUE(std::isnan(interval.half_width));
  EXPECT_FALSE(interval.below(4.0));
  EXPECT_FALSE(interval.above(2.0));
}

// 2,000 samples of eight normal numbers each: 95 % of the intervals contain the expectation, +- 4 sigma of a
// binomial distribution.
TEST(Interval, CoversWhatItSays) {
  int covered = 0;
  constexpr int kSamples = 2000;
  for (std::uint32_t sample = 0; sample < kSamples; ++sample) {
    RandomStream stream({7, sample, Purpose::kTest, 0, 0});
    Moments moments;
    for (int i = 0; i < 8; ++i) moments.add(3.0 + 2.0 * stream.normal());
    const Interval interval = interval_of(moments, 0.95);
    covered += !interval.below(3.0) && !interval.above(3.0);
  }
  EXPECT_NEAR(covered, 0.95 * kSamples, 4.0 * std::sqrt(kSamples * 0.95 * 0.05));
}

Moments of(int ones, int minus_ones, int zeros) {
  Moments moments;
  for (int i = 0; i < ones; ++i) moments.add(1.0);
  for (int i = 0; i < minus_ones; ++i) moments.add(-1.0);
  for (int i = 0; i < zeros; ++i) moments.add(0.0);
  return moments;
}

// Newcombe: "Two-sided confidence intervals for the single proportion", Statistics in Medicine 17, 1998, table I,
// method 3.
TEST(Share, HasWilsonsInterval) {
  const auto expect = [](int ones, int zeros, double low, double high) {
    const Interval interval = share_of(of(ones, 0, zeros), 0.95);
    EXPECT_NEAR(interval.mean, static_cast<double>(ones) / (ones + zeros), 1e-12);
    EXPECT_NEAR(interval.low(), low, 5e-5) << ones;
    EXPECT_NEAR(interval.high(), high, 5e-5) << ones;
  };
  expect(81, 182, 0.2553, 0.3662);
  expect(15, 133, 0.0624, 0.1605);
  expect(0, 20, 0.0, 0.1611);
  expect(1, 28, 0.0061, 0.1718);
  EXPECT_EQ(share_of({}, 0.95).count, 0u);
  EXPECT_FALSE(share_of(of(0, 0, 20), 0.95).above(0.0));
}

TEST(Share, ADifferenceHasAWidthWithoutAnyEvent) {
  const Interval none = difference_of_shares(of(0, 0, 100), 0.95), even = difference_of_shares(of(5, 5, 90), 0.95),
                 more = difference_of_shares(of(30, 2, 68), 0.95);
  EXPECT_EQ(none.mean, 0.0);
  EXPECT_NEAR(none.high(), 1.984 * std::sqrt(2.0) / 102.0, 1e-4);
  EXPECT_NEAR(none.low(), -none.high(), 1e-12);
  EXPECT_GT(even.high(), none.high());
  EXPECT_NEAR(more.mean, 0.28, 1e-12);
  EXPECT_TRUE(more.above(0.0));
  EXPECT_NEAR(0.5 * (more.low() + more.high()), 28.0 / 102.0, 1e-9);
}

}  // namespace
}  // namespace ttf::experiments::results
