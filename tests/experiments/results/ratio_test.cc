#include "experiments/results/ratio.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "core/random.h"

namespace ttf::experiments::results {
namespace {

using Pairs = std::vector<std::pair<double, double>>;

// Student's t, 97.5 %, of 2 degrees of freedom: every textbook's table.
constexpr double kT2 = 4.302653;

// Means 6 and 2, variances 1 and 1/4, covariance -1/2.
TEST(Ratio, IsFiellers) {
  const Pairs pairs{{5.0, 2.5}, {6.0, 2.0}, {7.0, 1.5}};
  const double squared = kT2 * kT2 / 3.0;
  const double a = 4.0 - squared * 0.25, b = 12.0 + squared * 0.5, c = 36.0 - squared;
  const Ratio ratio = ratio_of(pairs, 0.95);
  EXPECT_EQ(ratio.count, 3u);
  EXPECT_DOUBLE_EQ(ratio.value, 3.0);
  EXPECT_NEAR(ratio.low, (b - std::sqrt(b * b - a * c)) / a, 1e-5);
  EXPECT_NEAR(ratio.high, (b + std::sqrt(b * b - a * c)) / a, 1e-4);
}

// Proportional values have no spread about their ratio.
TEST(Ratio, OfProportionalValuesIsCertain) {
  const Ratio ratio = ratio_of(Pairs{{2.0, 1.0}, {6.0, 3.0}, {5.0, 2.5}, {7.0, 3.5}}, 0.95);
  EXPECT_NEAR(ratio.low, 2.0, 1e-6);
  EXPECT_NEAR(ratio.high, 2.0, 1e-6);
}

TEST(Ratio, HasNoIntervalWithoutABound) {
  EXPECT_TRUE(std::isnan(ratio_of(Pairs{}, 0.95).value));
  EXPECT_TRUE(std::isnan(ratio_of(Pairs{{1.0, 0.0}, {2.0, 0.0}}, 0.95).value));
  EXPECT_TRUE(std::isnan(ratio_of(Pairs{{-1.0, 1.0}, {-2.0, 1.0}}, 0.95).value));
  EXPECT_DOUBLE_EQ(ratio_of(Pairs{{3.0, 2.0}}, 0.95).value, 1.5);
  EXPECT_TRUE(std::isnan(ratio_of(Pairs{{3.0, 2.0}}, 0.95).low));
  const Ratio wide = ratio_of(Pairs{{1.0, 0.1}, {1.0, 5.0}}, 0.95);  // y may be 0
  EXPECT_GT(wide.value, 0.0);
  EXPECT_TRUE(std::isnan(wide.low));
}

// Two paradigms with a common draw of a heavy tail and one of their own each, before and after a change to `first` and
// `second` times as much.
std::vector<Quadruple> drawn(std::uint32_t sample, int drives, double first, double second) {
  RandomStream stream({11, sample, Purpose::kTest, 0, 0});
  std::vector<Quadruple> values;
  for (int i = 0; i < drives; ++i) {
    const double common = std::exp(0.7 * stream.normal());
    const auto one = [&](double scale) { return scale * common * std::exp(0.4 * stream.normal()); };
    const double first_before = one(2.0), first_after = one(2.0 * first), second_before = one(1.0);
    values.push_back({first_before, first_after, second_before, one(second)});
  }
  return values;
}

// How many of 3,000 samples have an interval that contains 2, the ratio of the means.
struct Covered {
  int by_ratio = 0, by_difference = 0;  // Fieller's interval; the difference's, over y's mean as if that were certain
};
constexpr int kRatioSamples = 3000;

// Twelve normal pairs a sample, with means 2 and 1; `together` moves both by their own size, `apart` y alone.
Covered covered(std::uint32_t draw, double together, double apart) {
  Covered found;
  for (std::uint32_t sample = 0; sample < kRatioSamples; ++sample) {
    RandomStream stream({draw, sample, Purpose::kTest, 0, 0});
    Pairs pairs;
    Moments differences, y;
    for (int i = 0; i < 12; ++i) {
      const double common = together * stream.normal();
      pairs.emplace_back(2.0 + 2.0 * common + 0.1 * stream.normal(), 1.0 + common + apart * stream.normal());
      differences.add(pairs.back().first - pairs.back().second);
      y.add(pairs.back().second);
    }
    const Ratio ratio = ratio_of(pairs, 0.95);
    found.by_ratio += ratio.low <= 2.0 && 2.0 <= ratio.high;
    const Interval difference = interval_of(differences, 0.95);
    found.by_difference += std::abs(difference.mean - y.mean()) <= difference.half_width;
  }
  return found;
}

// An interval that leaves the baseline's spread out is too wide where both rise and fall together, and too narrow where the
// baseline spreads by itself.
TEST(Ratio, CoversWhatItSays) {
  const double spread = std::sqrt(kRatioSamples * 0.95 * 0.05);
  const Covered both = covered(12, 0.3, 0.05), alone = covered(13, 0.0, 0.3);
  EXPECT_NEAR(both.by_ratio, 0.95 * kRatioSamples, 4.0 * spread);
  EXPECT_NEAR(alone.by_ratio, 0.95 * kRatioSamples, 4.0 * spread);
  EXPECT_GT(both.by_difference, 0.999 * kRatioSamples);
  EXPECT_LT(alone.by_difference, 0.8 * kRatioSamples);
}

// Both judge by the same test, so that words and per cent never contradict each other.
TEST(Ratio, ExcludesOneWhereTheDifferenceExcludesZero) {
  int certain = 0;
  for (std::uint32_t sample = 0; sample < 300; ++sample) {
    Pairs pairs;
    Moments differences;
    for (const Quadruple& one : drawn(sample, 12, 0.8, 1.0)) {
      pairs.emplace_back(one.first_after, one.first_before);
      differences.add(one.first_after - one.first_before);
    }
    const Ratio ratio = ratio_of(pairs, 0.95);
    if (std::isnan(ratio.low)) continue;
    const Interval difference = interval_of(differences, 0.95);
    EXPECT_EQ(ratio.high < 1.0, difference.below(0.0)) << sample;
    EXPECT_EQ(ratio.low > 1.0, difference.above(0.0)) << sample;
    certain += difference.below(0.0);
  }
  EXPECT_GT(certain, 20);
  EXPECT_LT(certain, 250);
}

// The changes of the first are 1, 2 and 3, those of the second 1 and 0 and -1: differences 0, 2, 4 of mean 2 and variance 4.
TEST(Interactions, AreDifferencesOfDifferences) {
  const std::vector<Quadruple> values{{5.0, 6.0, 3.0, 4.0}, {1.0, 3.0, 2.0, 2.0}, {0.0, 3.0, 8.0, 7.0}};
  const Interval interval = difference_of_differences(values, 0.95);
  EXPECT_EQ(interval.count, 3u);
  EXPECT_DOUBLE_EQ(interval.mean, 2.0);
  EXPECT_NEAR(interval.half_width, kT2 * 2.0 / std::sqrt(3.0), 1e-5);
}

// Means 4 to 2 and 2 to 2: a half against a whole. Without one of the drives, 9/2 to 7, 4 to 8 and 7/2 to 9 remain.
TEST(Interactions, AreRatiosOfRatios) {
  const std::vector<Quadruple> values{{5.0, 1.5, 1.5, 1.5}, {4.0, 2.0, 2.0, 2.0}, {3.0, 2.5, 2.5, 2.5}};
  const Interval interval = log_ratio_of_ratios(values, 0.95);
  EXPECT_EQ(interval.count, 3u);
  EXPECT_NEAR(interval.mean, std::log(0.5), 1e-12);
  const double a = std::log(4.5 / 7.0), b = std::log(0.5), c = std::log(3.5 / 9.0), mean = (a + b + c) / 3.0;
  const double squares = (a - mean) * (a - mean) + (b - mean) * (b - mean) + (c - mean) * (c - mean);
  EXPECT_NEAR(interval.half_width, kT2 * std::sqrt(2.0 / 3.0 * squares), 1e-6);
  const Ratio ratio = exponential(interval);
  EXPECT_NEAR(ratio.value, 0.5, 1e-12);
  EXPECT_NEAR(ratio.low * ratio.high, 0.25, 1e-12);
}

TEST(Interactions, OfMeansThatAreNotAboveZeroHaveNoRatio) {
  EXPECT_TRUE(std::isnan(log_ratio_of_ratios({}, 0.95).mean));
  const std::vector<Quadruple> nothing{{1.0, 0.0, 1.0, 1.0}, {2.0, 0.0, 1.0, 2.0}};
  EXPECT_TRUE(std::isnan(log_ratio_of_ratios(nothing, 0.95).mean));
  EXPECT_TRUE(std::isnan(log_ratio_of_ratios(nothing, 0.95).half_width));
  EXPECT_FALSE(std::isnan(difference_of_differences(nothing, 0.95).half_width));
}

// A mean that hangs on one drive has no interval.
TEST(Interactions, OfOneDriveAloneHaveNoInterval) {
  const std::vector<Quadruple> one{{1.0, 1.0, 1.0, 1.0}, {1.0, 0.0, 1.0, 1.0}, {1.0, 0.0, 1.0, 1.0}};
  EXPECT_NEAR(log_ratio_of_ratios(one, 0.95).mean, std::log(1.0 / 3.0), 1e-12);
  EXPECT_TRUE(std::isnan(log_ratio_of_ratios(one, 0.95).half_width));
  EXPECT_TRUE(std::isnan(log_ratio_of_ratios(std::vector<Quadruple>{{1.0, 1.0, 1.0, 1.0}}, 0.95).half_width));
}

TEST(Interactions, ChangeSignWithTheirSides) {
  for (std::uint32_t sample = 0; sample < 50; ++sample) {
    std::vector<Quadruple> values = drawn(sample, 9, 0.5, 0.9), paradigms, times;
    for (const Quadruple& one : values) {
      paradigms.push_back({one.second_before, one.second_after, one.first_before, one.first_after});
      times.push_back({one.first_after, one.first_before, one.second_after, one.second_before});
    }
    for (const auto of : {difference_of_differences, log_ratio_of_ratios}) {
      const Interval interval = of(values, 0.95);
      for (const auto& swapped : {of(paradigms, 0.95), of(times, 0.95)}) {
        EXPECT_EQ(swapped.mean, -interval.mean);
        EXPECT_EQ(swapped.half_width, interval.half_width);
      }
    }
  }
}

// 1,500 samples of 40 drives: both intervals contain the true value in 95 % of them. The jackknife's loses a little to heavy
// tails.
TEST(Interactions, CoverWhatTheySay) {
  constexpr int kSamples = 1500;
  int by_ratio = 0, by_difference = 0;
  for (std::uint32_t sample = 0; sample < kSamples; ++sample) {
    const Interval ratio = log_ratio_of_ratios(drawn(sample, 40, 0.5, 0.5), 0.95);  // no interaction by ratio
    by_ratio += !ratio.below(0.0) && !ratio.above(0.0);
    const Interval difference = difference_of_differences(drawn(sample, 40, 1.0, 1.0), 0.95);
    by_difference += !difference.below(0.0) && !difference.above(0.0);
  }
  const double spread = std::sqrt(kSamples * 0.95 * 0.05);
  EXPECT_NEAR(by_ratio, 0.95 * kSamples, 4.0 * spread);
  EXPECT_NEAR(by_difference, 0.95 * kSamples, 4.0 * spread);
}

// A change that leaves 60 % of one and 90 % of the other is found, with its size.
TEST(Interactions, AreFound) {
  const Ratio ratio = exponential(log_ratio_of_ratios(drawn(1, 400, 0.6, 0.9), 0.95));
  EXPECT_LT(ratio.high, 1.0);
  EXPECT_LT(ratio.low, 0.6 / 0.9);
  EXPECT_GT(ratio.high, 0.6 / 0.9);
}

}  // namespace
}  // namespace ttf::experiments::results
