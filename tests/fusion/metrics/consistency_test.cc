// NEES and NIS by hand, their bands against printed tables, and their verdicts on a right and a wrong filter.
#include "fusion/metrics/consistency.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "core/random.h"
#include "tests/fusion/textbook.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::metrics {
namespace {

TEST(NormalisedSquared, ByHand) {
  // [4 2; 2 3]^-1 = [3 -2; -2 4] / 8
  const linear::Matrix<2> p{{4.0, 2.0}, {2.0, 3.0}};
  EXPECT_NEAR(normalised_squared<2>(linear::Vector<2>(1.0, 1.0), p), 3.0 / 8.0, 1e-15);
  EXPECT_NEAR(normalised_squared<2>(linear::Vector<2>(1.0, -1.0), p), 11.0 / 8.0, 1e-15);
  const linear::Gaussian<2> estimate{.x = linear::Vector<2>(5.0, 7.0), .p = p};
  EXPECT_NEAR(nees<2>(estimate, linear::Vector<2>(6.0, 6.0)), 11.0 / 8.0, 1e-15);
  EXPECT_DOUBLE_EQ(normalised_squared<1>(linear::Vector<1>(3.0), linear::Matrix<1>(4.0)), 2.25);
}

// Abramowitz and Stegun, table 26.8, over the number of samples: 50 samples of 2 and of 1 degrees.
TEST(Consistency, BandsAreThoseOfTheTables) {
  Consistency two, one;
  for (int i = 0; i < 50; ++i) {
    two.add(2.0, 2);
    one.add(1.0, 1);
  }
  EXPECT_NEAR(two.band().low, 74.2219 / 50.0, 2e-6);
  EXPECT_NEAR(two.band().high, 129.561 / 50.0, 2e-5);
  EXPECT_NEAR(one.band().low, 32.3574 / 50.0, 2e-6);
  EXPECT_NEAR(one.band().high, 71.4202 / 50.0, 2e-6);
  EXPECT_NEAR(one.band(0.005).low, 27.9907 / 50.0, 2e-6);
  EXPECT_NEAR(one.band(0.005).high, 79.4900 / 50.0, 2e-6);
  EXPECT_TRUE(two.consistent() && one.consistent());
}

TEST(Consistency, MeanOfDifferentDegrees) {
  Consistency mixed;
  EXPECT_TRUE(std::isnan(mixed.mean()) && std::isnan(mixed.expected()) && std::isnan(mixed.band().low));
  EXPECT_FALSE(mixed.consistent()) << "of nothing";
  mixed.add(1.5, 2);
  mixed.add(4.5, 3);
  mixed.add(0.0, 4);
  EXPECT_DOUBLE_EQ(mixed.mean(), 2.0);
  EXPECT_DOUBLE_EQ(mixed.expected(), 3.0);
  EXPECT_EQ(mixed.samples(), 3u);
  EXPECT_EQ(mixed.degrees(), 9u);
  // 9 degrees, the same table: 2.70039, 19.0228.
  EXPECT_NEAR(mixed.band().low, 2.70039 / 3.0, 2e-6);
  EXPECT_NEAR(mixed.band().high, 19.0228 / 3.0, 2e-5);
}

TEST(Consistency, OutsideOnEitherSide) {
  Consistency low, high;
  for (int i = 0; i < 50; ++i) {
    low.add(1.4, 2);  // band 1.48 to 2.59
    high.add(2.7, 2);
  }
  EXPECT_FALSE(low.consistent());
  EXPECT_FALSE(high.consistent());
  EXPECT_LT(low.mean(), low.band().low);
  EXPECT_GT(high.mean(), high.band().high);
}

struct Judged {
  Consistency nees, nis;
};

// Constant velocity along a line, T = 1, measured positions: `runs` independent runs, each judged at its last step.
Judged judged(double true_q, double assumed_q, std::uint32_t runs) {
  Judged result;
  for (std::uint32_t run = 0; run < runs; ++run) {
    RandomStream stream({.seed = 51, .replication = run, .purpose = Purpose::kTest});
    linear::LinearStep<2> step;
    step.f << 1.0, 1.0, 0.0, 1.0;
    step.q << assumed_q / 3.0, assumed_q / 2.0, assumed_q / 2.0, assumed_q;
    linear::Gaussian<2> estimate;
    estimate.p.diagonal() << 1.0, 4.0;
    linear::Vector<2> truth(stream.normal(), 2.0 * stream.normal());
    for (int k = 1; k <= 20; ++k) {
      // The Cholesky factor of q [1/3 1/2; 1/2 1] is sqrt(q) [1/sqrt 3, 0; sqrt 3 / 2, 1/2].
      const double a = std::sqrt(true_q) * stream.normal(), b = std::sqrt(true_q) * stream.normal();
      truth = (step.f * truth + linear::Vector<2>(a / std::sqrt(3.0), a * std::sqrt(0.75) + 0.5 * b)).eval();
      predict<2>(estimate, step);
      linear::LinearMeasurement<2, 1> z;
      z.h << 1.0, 0.0;
      z.z << truth(0) + stream.normal();
      const Correction<2, 1> correction = update<2, 1>(estimate, z);
      if (k == 20) result.nis.add(normalised_squared<1>(correction.nu, correction.s), 1);
    }
    result.nees.add(nees<2>(estimate, truth), 2);
  }
  return result;
}

TEST(Consistency, RightModelInsideWrongOnesOutside) {
  const Judged right = judged(1.0, 1.0, 2000), confident = judged(1.0, 0.1, 500), timid = judged(0.1, 1.0, 500);
  EXPECT_TRUE(right.nees.consistent()) << right.nees.mean();
  EXPECT_TRUE(right.nis.consistent()) << right.nis.mean();
  EXPECT_GT(confident.nees.mean(), confident.nees.band().high);
  EXPECT_GT(confident.nis.mean(), confident.nis.band().high);
  EXPECT_LT(timid.nees.mean(), timid.nees.band().low);
  EXPECT_LT(timid.nis.mean(), timid.nis.band().low);
}

TEST(Consistency, AllocatesNothing) {
  const std::int64_t before = support::allocations();
  Consistency sum;
  sum.add(normalised_squared<4>(linear::Vector<4>::Ones(), linear::Matrix<4>::Identity()), 4);
  EXPECT_TRUE(sum.consistent());
  EXPECT_EQ(support::allocations(), before);
}

TEST(Consistency, ADivergingFilterIsNotConsistent) {
  const double bad[] = {-0.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  for (const double squared : bad) {
    Consistency sum;
    sum.add(2.0, 2);
    EXPECT_TRUE(sum.consistent());
    sum.add(squared, 2);
    sum.add(2.0, 2);
    EXPECT_FALSE(sum.consistent()) << squared;
    EXPECT_EQ(sum.samples(), 3u);
  }
}

TEST(ConsistencyDeathTest, DegreesAndTailsAreChecked) {
  Consistency sum;
  EXPECT_DEATH(sum.add(0.1, 0), "0 degrees");
  EXPECT_DEATH(sum.band(0.5), "tail 0.5");
}

}  // namespace
}  // namespace ttf::fusion::metrics
