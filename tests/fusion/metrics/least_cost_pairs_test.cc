// The pairs are the best of all, found by trying all; ties by the stated rule.
#include "fusion/metrics/least_cost_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::metrics {
namespace {

constexpr double kApart = std::numeric_limits<double>::infinity();
using Costs = std::vector<std::vector<double>>;  // kApart where a pair is not offered

// The largest sum of gains over all ways to leave a row alone or give it a free column.
double best_of_all(const Costs& costs, double bonus, std::size_t row = 0, unsigned taken = 0) {
  if (row == costs.size()) return 0.0;
  double best = best_of_all(costs, bonus, row + 1, taken);
  for (std::size_t c = 0; c < costs[row].size(); ++c)
    if (costs[row][c] <= 1.0 && !(taken >> c & 1u))
      best = std::max(best, bonus + 1.0 - costs[row][c] + best_of_all(costs, bonus, row + 1, taken | 1u << c));
  return best;
}

Costs drawn(RandomStream& stream, std::size_t rows, std::size_t columns, double density, int levels) {
  Costs costs(rows, std::vector<double>(columns, kApart));
  for (auto& row : costs)
    for (double& cost : row)
      if (stream.uniform() < density)
        cost = levels == 0 ? stream.uniform() : static_cast<double>(stream.integer(0, levels)) / levels;
  return costs;
}

std::vector<int> solved(LeastCostPairs& pairs, const Costs& costs, std::size_t columns, double bonus,
                        bool backwards = false) {
  pairs.begin(costs.size(), columns);
  for (std::size_t k = 0; k < costs.size() * columns; ++k) {
    const std::size_t at = backwards ? costs.size() * columns - 1 - k : k, row = at / columns, column = at % columns;
    if (costs[row][column] <= 1.0) pairs.offer(row, column, costs[row][column]);
  }
  pairs.solve(bonus);
  return {pairs.column_of().begin(), pairs.column_of().end()};
}

double gain_of(const Costs& costs, const std::vector<int>& column_of, double bonus) {
  double sum = 0.0;
  unsigned taken = 0;
  for (std::size_t row = 0; row < column_of.size(); ++row) {
    if (column_of[row] == LeastCostPairs::kNone) continue;
    const auto column = static_cast<std::size_t>(column_of[row]);
    EXPECT_FALSE(taken >> column & 1u) << "column " << column << " twice";
    taken |= 1u << column;
    EXPECT_LE(costs[row][column], 1.0) << "not offered";
    sum += bonus + 1.0 - costs[row][column];
  }
  return sum;
}

// P1 and P3 of drawn problems: dense squares, sparse and oblong ones, with and without ties.
TEST(LeastCostPairs, IsAsGoodAsTryingAllWays) {
  LeastCostPairs pairs(6, 6);  // one for all: no state may survive a problem
  for (std::uint32_t index = 0; index < 1500; ++index) {
    RandomStream stream({.seed = 21, .purpose = Purpose::kTest, .index = index});
    const auto rows = static_cast<std::size_t>(stream.integer(0, 6));
    const auto columns = index % 3 == 0 ? rows : static_cast<std::size_t>(stream.integer(0, 6));
    const double density = index % 3 == 0 ? 1.0 : stream.uniform();
    const Costs costs = drawn(stream, rows, columns, density, index % 2 == 0 ? 0 : 4);
    for (const double bonus : {LeastCostPairs::kLeastCost, LeastCostPairs::most_pairs(rows, columns)}) {
      const std::vector<int> column_of = solved(pairs, costs, columns, bonus);
      ASSERT_NEAR(gain_of(costs, column_of, bonus), best_of_all(costs, bonus), 1e-11) << "problem " << index;
      ASSERT_EQ(column_of, solved(pairs, costs, columns, bonus, true)) << "problem " << index;
    }
  }
}

// P2, word by word.
TEST(LeastCostPairs, TiesGoToTheSmallerAndTheEarlier) {
  LeastCostPairs pairs(6, 6);
  int tied = 0;
  for (std::uint32_t index = 0; index < 1500; ++index) {
    RandomStream stream({.seed = 22, .purpose = Purpose::kTest, .index = index});
    const auto rows = static_cast<std::size_t>(stream.integer(1, 6)),
               columns = static_cast<std::size_t>(stream.integer(1, 6));
    const Costs costs = drawn(stream, rows, columns, 0.8, 2);  // 0, 1/2, 1: sums are exact
    const std::vector<int> of = solved(pairs, costs, columns, LeastCostPairs::most_pairs(rows, columns));
    std::vector<bool> free(columns, true);
    for (const int column : of)
      if (column != LeastCostPairs::kNone) free[static_cast<std::size_t>(column)] = false;
    for (std::size_t r = 0; r < rows; ++r) {
      const bool paired = of[r] != LeastCostPairs::kNone;
      const std::size_t now = paired ? static_cast<std::size_t>(of[r]) : columns;
      for (std::size_t c = 0; paired && c < now; ++c)
        EXPECT_FALSE(free[c] && costs[r][c] == costs[r][now]) << index << ": a smaller column is free for row " << r;
      for (std::size_t later = r + 1; later < rows; ++later) {
        if (of[later] == LeastCostPairs::kNone) continue;
        const auto its = static_cast<std::size_t>(of[later]);
        if (!paired) {
          EXPECT_NE(costs[r][its], costs[later][its]) << index << ": row " << later << " goes before " << r;
        } else if (its < now && costs[r][its] <= 1.0 && costs[later][now] <= 1.0) {
          const bool equal = costs[r][its] + costs[later][now] == costs[r][now] + costs[later][its];
          EXPECT_FALSE(equal) << index << ": rows " << r << " and " << later << " cross without need";
          ++tied;
        }
      }
    }
  }
  EXPECT_GT(tied, 100) << "nothing was tried";
}

TEST(LeastCostPairs, TiesByHand) {
  LeastCostPairs pairs(3, 3);
  const double bonus = LeastCostPairs::most_pairs(3, 3);
  EXPECT_EQ(solved(pairs, {{0.5, 0.5, 0.5}}, 3, bonus), (std::vector<int>{0}));
  EXPECT_EQ(solved(pairs, {{0.5}, {0.5}, {0.5}}, 1, bonus),
            (std::vector<int>{0, LeastCostPairs::kNone, LeastCostPairs::kNone}));
  const Costs same(3, std::vector<double>(3, 0.25));
  EXPECT_EQ(solved(pairs, same, 3, bonus), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(solved(pairs, same, 3, LeastCostPairs::kLeastCost), (std::vector<int>{0, 1, 2}));
}

// Least cost leaves the outer two apart: 0 and twice the cut-off's half against 0.75 + 0.75. Most pairs takes both.
TEST(LeastCostPairs, LeastCostAgainstMostPairs) {
  LeastCostPairs pairs(2, 2);
  const Costs costs{{0.75, 0.0}, {kApart, 0.75}};
  EXPECT_EQ(solved(pairs, costs, 2, LeastCostPairs::kLeastCost), (std::vector<int>{1, LeastCostPairs::kNone}));
  EXPECT_EQ(solved(pairs, costs, 2, LeastCostPairs::most_pairs(2, 2)), (std::vector<int>{0, 1}));
  // Equal sums, 0 + 1 and 0.5 + 0.5: more pairs.
  EXPECT_EQ(solved(pairs, {{0.5, 0.0}, {kApart, 0.5}}, 2, LeastCostPairs::kLeastCost), (std::vector<int>{0, 1}));
}

// 300 x 300, all offered: a shuffled diagonal of zeros, which only one assignment has.
TEST(LeastCostPairs, LargeDenseSquareWithoutAllocation) {
  constexpr std::size_t kN = 300;
  LeastCostPairs pairs(kN, kN);
  const std::int64_t before = support::allocations();
  RandomStream stream({.seed = 23, .purpose = Purpose::kTest});
  pairs.begin(kN, kN);
  for (std::size_t r = 0; r < kN; ++r)
    for (std::size_t c = 0; c < kN; ++c) pairs.offer(r, c, c == (7 * r + 5) % kN ? 0.0 : stream.uniform(0.001, 1.0));
  pairs.solve(LeastCostPairs::kLeastCost);
  EXPECT_EQ(support::allocations(), before);
  for (std::size_t r = 0; r < kN; ++r) ASSERT_EQ(pairs.column_of()[r], static_cast<int>((7 * r + 5) % kN));
}

TEST(PairingDeathTest, OfferedPairsAreChecked) {
  LeastCostPairs pairs(2, 2);
  pairs.begin(2, 2);
  pairs.offer(0, 0, 0.5);
  EXPECT_DEATH(pairs.offer(0, 0, 0.5), "offered again");
  EXPECT_DEATH(pairs.offer(0, 1, 1.5), "cost 1.5");
  EXPECT_DEATH(pairs.offer(2, 0, 0.5), "row 2 of 2");
  EXPECT_DEATH(pairs.begin(3, 1), "3 x 1 of at most 2 x 2");
}

}  // namespace
}  // namespace ttf::fusion::metrics
