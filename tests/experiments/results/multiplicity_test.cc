#include "experiments/results/multiplicity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/random.h"

namespace ttf::experiments::results {
namespace {

Interval interval(std::initializer_list<double> samples, double confidence = 0.95) {
  Moments moments;
  for (const double x : samples) moments.add(x);
  return interval_of(moments, confidence);
}

// Student's t of 1 degree is Cauchy's distribution: p = 1 - 2 atan(t) / pi. With 2 degrees, p = 1 - t / sqrt(2 + t^2).
TEST(PValue, IsStudents) {
  // Mean 2, variance 2: t = 2.
  EXPECT_NEAR(p_value(interval({1.0, 3.0}), 0.95), 1.0 - 2.0 * std::atan(2.0) / std::numbers::pi, 1e-12);
  // Mean 2, variance 1: t = 2 sqrt(3).
  const double t = 2.0 * std::sqrt(3.0);
  EXPECT_NEAR(p_value(interval({1.0, 2.0, 3.0}), 0.95), 1.0 - t / std::sqrt(2.0 + t * t), 1e-12);
  EXPECT_NEAR(p_value(interval({-1.0, -2.0, -3.0}, 0.6), 0.6), 1.0 - t / std::sqrt(2.0 + t * t), 1e-12);
  // The interval's end is at 0 where p is 1 - confidence.
  const Interval edge{5, 0.7, 0.7};
  EXPECT_NEAR(p_value(edge, 0.9), 0.1, 1e-12);
}

TEST(PValue, WithoutSpreadOrSamples) {
  EXPECT_TRUE(std::isnan(p_value(interval({}), 0.95)));
  EXPECT_TRUE(std::isnan(p_value(interval({3.0}), 0.95)));
  EXPECT_EQ(p_value(interval({3.0, 3.0}), 0.95), 0.0);
  EXPECT_EQ(p_value(interval({0.0, 0.0}), 0.95), 1.0);
}

// At 5 % of four: 0.01 <= 0.05/4, 0.015 <= 0.05/3, 0.03 > 0.05/2, and so 0.04 fails, too, although it is below 0.05/1.
TEST(Holm, StepsDown) {
  const std::vector<double> p{0.04, 0.01, 0.03, 0.015};
  EXPECT_EQ(holm(p, 0.05), (std::vector<bool>{false, true, false, true}));
  EXPECT_EQ(holm(p, 0.12), (std::vector<bool>{true, true, true, true}));
  EXPECT_EQ(holm(p, 0.03), (std::vector<bool>{false, false, false, false}));
}

TEST(Holm, AMissingValueIsNoComparison) {
  const std::vector<double> p{std::nan(""), 0.02, std::nan(""), 0.05};
  EXPECT_EQ(holm(p, 0.05), (std::vector<bool>{false, true, false, true}));
  EXPECT_TRUE(holm({}, 0.05).empty());
}

TEST(Family, CountsItsComparisons) {
  const std::vector<Interval> differences{interval({1.0, 1.001, 0.999}), interval({1.0}), interval({-1.0, 1.0, 0.1}),
                                          interval({-2.0, -2.001, -2.002})};
  const Family family = family_of(differences, 0.95);
  EXPECT_EQ(family.comparisons, 3u);
  EXPECT_EQ(family.certain, 2u);
  EXPECT_EQ(family.stays, (std::vector<bool>{true, false, false, true}));
}

// 48 comparisons of nothing: single intervals err in most families, the family itself in at most one of 20.
TEST(Family, ErrsRarelyAsAWhole) {
  constexpr int kFamilies = 1000, kComparisons = 48;
  int alone = 0, together = 0;
  for (std::uint32_t f = 0; f < kFamilies; ++f) {
    RandomStream stream({13, f, Purpose::kTest, 0, 0});
    std::vector<Interval> differences;
    bool any = false;
    for (int c = 0; c < kComparisons; ++c) {
      Moments moments;
      for (int i = 0; i < 10; ++i) moments.add(stream.normal());
      differences.push_back(interval_of(moments, 0.95));
      any = any || differences.back().below(0.0) || differences.back().above(0.0);
    }
    alone += any;
    together += family_of(differences, 0.95).certain > 0;
  }
  EXPECT_GT(alone, 0.85 * kFamilies);
  EXPECT_LT(together, 0.05 * kFamilies + 4.0 * std::sqrt(kFamilies * 0.05 * 0.95));
}

}  // namespace
}  // namespace ttf::experiments::results
