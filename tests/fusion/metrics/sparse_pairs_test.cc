// Sparse pairs are those of the dense solver, component by component.
#include "fusion/metrics/sparse_pairs.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/random.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::metrics {
namespace {

struct Offer {
  std::size_t row, column;
  double cost;
};

std::vector<Offer> drawn_offers(RandomStream& draw, std::size_t rows, std::size_t columns, double density) {
  std::vector<Offer> offers;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column)
      if (draw.uniform() < density)
        offers.push_back({row, column, draw.uniform() < 0.3 ? 0.5 : draw.uniform(0.0, 1.0)});
  return offers;
}

double gain_of_offers(const std::vector<Offer>& offers, std::span<const int> column_of, std::size_t& pairs) {
  double sum = 0.0;
  pairs = 0;
  for (const Offer& offer : offers)
    if (column_of[offer.row] == static_cast<int>(offer.column)) {
      sum += 1.0 - offer.cost;
      ++pairs;
    }
  return sum;
}

TEST(SparsePairs, AreThoseOfTheDenseProblem) {
  SparsePairs sparse;  // one for all: no state may survive a problem
  for (std::uint32_t index = 0; index < 300; ++index) {
    RandomStream draw({.seed = 51, .purpose = Purpose::kTest, .index = index});
    const auto rows = static_cast<std::size_t>(draw.integer(0, 20)),
               columns = static_cast<std::size_t>(draw.integer(0, 20));
    const std::vector<Offer> offers = drawn_offers(draw, rows, columns, draw.uniform(0.0, 0.3));
    for (const Best best : {Best::kLeastCost, Best::kMostPairs}) {
      LeastCostPairs dense(rows, columns);
      dense.begin(rows, columns);
      sparse.begin(rows, columns);
      for (std::size_t i = 0; i < offers.size(); ++i) {
        dense.offer(offers[i].row, offers[i].column, offers[i].cost);
        const Offer& backwards = offers[offers.size() - 1 - i];
        sparse.offer(backwards.row, backwards.column, backwards.cost);
      }
      dense.solve(best == Best::kMostPairs ? LeastCostPairs::most_pairs(rows, columns) : LeastCostPairs::kLeastCost);
      sparse.solve(best);
      std::size_t pairs = 0, expected_pairs = 0;
      const double gain = gain_of_offers(offers, sparse.column_of(), pairs);
      ASSERT_NEAR(gain, gain_of_offers(offers, dense.column_of(), expected_pairs), 1e-11) << index;
      ASSERT_EQ(pairs, expected_pairs) << index;
    }
  }
}

TEST(SparsePairs, AllocateNothingTheSecondTime) {
  RandomStream draw({.seed = 52, .purpose = Purpose::kTest});
  const std::vector<Offer> offers = drawn_offers(draw, 60, 60, 0.03);
  SparsePairs pairs;
  std::int64_t before = 0;
  for (const int pass : {1, 2}) {
    if (pass == 2) before = support::allocations();
    pairs.begin(60, 60);
    for (const Offer& offer : offers) pairs.offer(offer.row, offer.column, offer.cost);
    pairs.solve(Best::kMostPairs);
  }
  EXPECT_EQ(support::allocations(), before);
}

TEST(SparsePairsDeathTest, OffersAreChecked) {
  SparsePairs pairs;
  pairs.begin(2, 3);
  EXPECT_DEATH(pairs.offer(2, 0, 0.5), "row 2 of 2");
  EXPECT_DEATH(pairs.offer(0, 3, 0.5), "column 3 of 3");
  EXPECT_DEATH(pairs.offer(0, 0, 1.5), "cost 1.5");
}

}  // namespace
}  // namespace ttf::fusion::metrics
