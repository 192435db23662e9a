#include "experiments/results/equivalence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <utility>

#include "core/random.h"

namespace ttf::experiments::results {
namespace {

Agreement agreement(Margin margin, std::initializer_list<std::pair<double, double>> pairs) {
  EquivalenceTest test(margin);
  for (const auto& [x, y] : pairs) test.add(x, y);
  return test.agreement(0.95);
}

// Differences of -0.1, 0 and 0.1 beside `off`: off +- 4.3027 * 0.1 / sqrt(3) = off +- 0.24842.
Agreement three(double off, Margin margin) {
  return agreement(margin, {{off - 0.1, 0.0}, {off, 0.0}, {off + 0.1, 0.0}});
}

TEST(Equivalence, TheWholeIntervalIsWithinTheMargin) {
  EXPECT_EQ(three(0.0, {0.249, false}), Agreement::kWithin);
  EXPECT_EQ(three(0.0, {0.248, false}), Agreement::kUndecided);
  EXPECT_EQ(three(0.1, {0.249, false}), Agreement::kUndecided);
  EXPECT_EQ(three(-0.1, {0.349, false}), Agreement::kWithin);
  EXPECT_EQ(three(0.5, {0.251, false}), Agreement::kBeyond);
  EXPECT_EQ(three(-0.5, {0.251, false}), Agreement::kBeyond);
  EXPECT_EQ(three(0.5, {0.252, false}), Agreement::kUndecided);
}

// A share of 10 % is 1 where the mean is 10. Where the second measure spreads, the margin does, too: 1 +- 4.3027 * 0.9 / sqrt(3).
TEST(Equivalence, AShareIsOfTheSecondMeasure) {
  EXPECT_EQ(agreement({0.1, true}, {{9.0, 9.0}, {10.0, 10.0}, {11.0, 11.0}}), Agreement::kWithin);
  EXPECT_EQ(agreement({0.1, true}, {{-9.0, -9.0}, {-10.0, -10.0}, {-11.0, -11.0}}), Agreement::kWithin);
  EXPECT_EQ(agreement({0.1, true}, {{1.0, 1.0}, {10.0, 10.0}, {19.0, 19.0}}), Agreement::kUndecided);
  EXPECT_EQ(agreement({0.1, true}, {{18.0, 9.0}, {20.0, 10.0}, {22.0, 11.0}}), Agreement::kBeyond);
}

TEST(Equivalence, OnePairSaysNothing) {
  EXPECT_EQ(agreement({}, {}), Agreement::kUndecided);
  EXPECT_EQ(agreement({}, {{1.0, 1.0}}), Agreement::kUndecided);
  EXPECT_EQ(agreement({}, {{1.0, 1.0}, {std::nan(""), 1.0}}), Agreement::kUndecided);
  EXPECT_EQ(agreement({}, {{1.0, 1.0}, {1.0, 1.0}}), Agreement::kWithin);
}

// At the margin itself the test is wrong in at most 2.5 % of all samples of any size; within it, more drives help.
TEST(Equivalence, FewSamplesAgreeNoMoreThanMany) {
  constexpr int kSamples = 4000;
  const auto share_of_agreements = [](int size, double off) {
    int within = 0;
    for (std::uint32_t sample = 0; sample < kSamples; ++sample) {
      RandomStream stream({11, sample, Purpose::kTest, static_cast<std::uint16_t>(size), 0});
      EquivalenceTest test({0.5, false});
      for (int i = 0; i < size; ++i) test.add(off + stream.normal(), 0.0);
      within += test.agreement(0.95) == Agreement::kWithin;
    }
    return static_cast<double>(within) / kSamples;
  };
  const double most = 0.025 + 4.0 * std::sqrt(0.025 * 0.975 / kSamples);
  for (const int size : {2, 3, 8, 50}) {
    EXPECT_LT(share_of_agreements(size, 0.5), most) << size;
    EXPECT_LT(share_of_agreements(size, -0.5), most) << size;
  }
  EXPECT_LT(share_of_agreements(3, 0.0), 0.1);
  EXPECT_GT(share_of_agreements(50, 0.0), 0.8);
}

}  // namespace
}  // namespace ttf::experiments::results
