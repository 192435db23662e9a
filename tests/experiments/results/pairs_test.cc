#include "experiments/results/pairs.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ttf::experiments::results {
namespace {

const std::vector<std::string> kParadigms{"tt", "adva", "buff"};

// Twenty drives, with a half width of 1. Student's t of 19 degrees and 97.5 % is 2.093: a mean of m has t = 2.093 m.
PairedDifference pair_of(std::size_t point, std::size_t one, std::size_t other, double mean) {
  return {point, one, other, {20, mean, 1.0}, false};
}

// p of 1.2, 1.3 and 1.4 is 0.021, 0.0137 and 0.0087: each is certain by itself. Of six, Holm's method asks for 0.05 / 6 = 0.0083.
TEST(Pairs, AreOneFamily) {
  std::vector<PairedDifference> all;
  for (const double mean : {1.2, -1.3, 1.4, 0.1, 0.2, 0.3}) all.push_back(pair_of(0, 0, 1, mean));
  const Pairs undecided = judged_together(all, 0.95);
  EXPECT_EQ(undecided.family.comparisons, 6u);
  EXPECT_EQ(undecided.family.certain, 0u);
  all[2] = pair_of(0, 0, 1, 1.5);  // p = 0.0053, and then 0.0137 of five is held against 0.01
  const Pairs one = judged_together(all, 0.95);
  EXPECT_EQ(one.family.certain, 1u);
  EXPECT_TRUE(one.all[2].stays);
  EXPECT_FALSE(one.all[1].stays);
}

TEST(Pairs, ThatAreCertainAreNamedWithTheirPoints) {
  const std::vector<std::string> points{"drive first", "drive second"};
  const Pairs pairs = judged_together({pair_of(0, 0, 1, 0.2), pair_of(0, 0, 2, 0.1), pair_of(0, 1, 2, -5.0),
                                       pair_of(1, 0, 1, 4.0), pair_of(1, 0, 2, -0.1), pair_of(1, 1, 2, -6.0)},
                                      0.95);
  EXPECT_EQ(certain_pairs(pairs, kParadigms, points),
            "adva less than buff at drive first and at drive second; adva less than tt at drive second");
}

TEST(Pairs, OfOnePointNeedNoName) {
  const std::vector<std::string> points{"the one point"};
  EXPECT_EQ(certain_pairs(judged_together({pair_of(0, 0, 1, -9.0)}, 0.95), kParadigms, points), "tt less than adva");
  EXPECT_EQ(certain_pairs(judged_together({pair_of(0, 0, 1, -0.9)}, 0.95), kParadigms, points), "");
  EXPECT_EQ(certain_pairs({}, kParadigms, points), "");
}

TEST(Pairs, CountMoreThanThreePoints) {
  std::vector<PairedDifference> all;
  std::vector<std::string> points;
  for (std::size_t point = 0; point < 5; ++point) {
    all.push_back(pair_of(point, 0, 1, point == 3 ? 7.0 : -7.0));
    points.push_back("noise " + std::to_string(point));
  }
  EXPECT_EQ(certain_pairs(judged_together(all, 0.95), kParadigms, points),
            "tt less than adva at 4 of 5 points; adva less than tt at noise 3");
}

}  // namespace
}  // namespace ttf::experiments::results
