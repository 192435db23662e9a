#include "experiments/results/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

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

}  // namespace
}  // namespace ttf::experiments::results
