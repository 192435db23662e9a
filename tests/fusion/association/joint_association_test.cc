// Joint probabilities against the enumeration of all joint events, and the approximation for too many tracks.
#include "fusion/association/joint_association.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/random.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::association {
namespace {

struct Table {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;  // by row
  Table(std::size_t r, std::size_t c) : rows(r), columns(c), values(r * c) {}
  double& at(std::size_t r, std::size_t c) { return values[r * columns + c]; }
  double at(std::size_t r, std::size_t c) const { return values[r * columns + c]; }
  std::vector<Pair> pairs() const {
    std::vector<Pair> list;
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < columns; ++c)
        if (at(r, c) > 0.0) list.push_back({static_cast<int>(r), static_cast<int>(c), at(r, c)});
    return list;
  }
};

struct Probabilities {
  Table of;
  std::vector<double> none;  // by column
  double all = 0.0;
  explicit Probabilities(const Table& weights) : of(weights.rows, weights.columns), none(weights.columns) {}
};

// Enumerates all events: the row-th observation is clutter, or belongs to any track still free.
void enumerate(const Table& weights, std::size_t row, double weight, std::vector<int>& row_of, Probabilities& sums) {
  if (row == weights.rows) {
    sums.all += weight;
    for (std::size_t c = 0; c < weights.columns; ++c) {
      if (row_of[c] < 0)
        sums.none[c] += weight;
      else
        sums.of.at(static_cast<std::size_t>(row_of[c]), c) += weight;
    }
    return;
  }
  enumerate(weights, row + 1, weight, row_of, sums);
  for (std::size_t c = 0; c < weights.columns; ++c) {
    if (weights.at(row, c) <= 0.0 || row_of[c] >= 0) continue;
    row_of[c] = static_cast<int>(row);
    enumerate(weights, row + 1, weight * weights.at(row, c), row_of, sums);
    row_of[c] = -1;
  }
}

Probabilities by_enumeration(const Table& weights) {
  Probabilities result(weights);
  std::vector<int> row_of(weights.columns, -1);
  enumerate(weights, 0, 1.0, row_of, result);
  for (double& value : result.of.values) value /= result.all;
  for (double& value : result.none) value /= result.all;
  return result;
}

Probabilities by_solving(JointAssociation& joint, const Table& weights) {
  joint.solve(weights.pairs(), weights.rows, weights.columns);
  Probabilities result(weights);
  for (std::size_t c = 0; c < weights.columns; ++c) {
    result.none[c] = joint.none_of_column(c);
    int previous = -1;
    for (const JointAssociation::Shared& shared : joint.of_column(c)) {
      EXPECT_GT(shared.row, previous) << "in the order of observations";
      previous = shared.row;
      result.of.at(static_cast<std::size_t>(shared.row), c) = shared.probability;
    }
  }
  return result;
}

// Weights over twelve orders of magnitude; `density` of the pairs share a gate.
Table drawn(RandomStream& stream, std::size_t rows, std::size_t columns, double density) {
  Table weights(rows, columns);
  for (double& value : weights.values)
    if (stream.uniform() < density) value = std::pow(10.0, stream.uniform(-6.0, 6.0));
  return weights;
}

TEST(JointAssociation, EqualsTheEnumerationOfAllEvents) {
  RandomStream stream({.seed = 1});
  JointAssociation joint(7, 7);
  for (int draw = 0; draw < 2000; ++draw) {
    const auto rows = static_cast<std::size_t>(stream.integer(1, 6));
    const auto columns = static_cast<std::size_t>(stream.integer(1, 6));
    const Table weights = drawn(stream, rows, columns, stream.uniform(0.2, 1.0));
    const Probabilities expected = by_enumeration(weights), found = by_solving(joint, weights);
    for (std::size_t i = 0; i < expected.of.values.size(); ++i)
      ASSERT_LE(std::abs(found.of.values[i] - expected.of.values[i]), 1e-12 * expected.of.values[i])
          << draw << ": " << i;
    for (std::size_t c = 0; c < columns; ++c)
      ASSERT_LE(std::abs(found.none[c] - expected.none[c]), 1e-12 * expected.none[c]) << draw << ": none of " << c;
  }
  EXPECT_EQ(joint.approximated(), 0u);
}

// Each event has one probability, so they sum to one, in the largest exact tables, too.
TEST(JointAssociation, EachTracksProbabilitiesHaveTheSumOne) {
  RandomStream stream({.seed = 2});
  for (const auto& [rows, columns] : {std::pair<std::size_t, std::size_t>{12, 12}, {12, 15}, {63, 10}, {10, 63}}) {
    JointAssociation joint(rows, columns);
    const Probabilities found = by_solving(joint, drawn(stream, rows, columns, 1.0));
    EXPECT_EQ(joint.approximated(), 0u) << rows << " x " << columns;
    for (std::size_t c = 0; c < columns; ++c) {
      double sum = found.none[c];
      for (std::size_t r = 0; r < rows; ++r) sum += found.of.at(r, c);
      EXPECT_NEAR(sum, 1.0, 1e-12) << rows << " x " << columns;
    }
    for (std::size_t r = 0; r < rows; ++r) {
      double sum = 0.0;
      for (std::size_t c = 0; c < columns; ++c) sum += found.of.at(r, c);
      EXPECT_LE(sum, 1.0 + 1e-12);
    }
  }
}

TEST(JointAssociation, TheLargestAndTheSmallestWeightsStayNumbers) {
  JointAssociation joint(12, 12);
  Table weights(12, 12);
  for (std::size_t i = 0; i < weights.values.size(); ++i)
    weights.values[i] = i % 3 == 0 ? 1e-300 : JointAssociation::kLargestWeight;
  const Probabilities found = by_solving(joint, weights);
  for (std::size_t c = 0; c < 12; ++c) {
    double sum = found.none[c];
    for (std::size_t r = 0; r < 12; ++r) sum += found.of.at(r, c);
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

// One track more than the table holds: the result is approximate, counted, and still made of probabilities.
// It is exact for a track without rivals.
TEST(JointAssociation, ALargeClusterIsApproximatedAndCounted) {
  RandomStream stream({.seed = 3});
  JointAssociation joint(20, 20);
  Table weights = drawn(stream, 20, 20, 1.0);
  for (std::size_t i = 0; i < 20; ++i) weights.at(0, i) = weights.at(i, 0) = 0.0;
  weights.at(0, 0) = 3.0;
  const Probabilities found = by_solving(joint, weights);
  EXPECT_EQ(joint.approximated(), 1u) << "the cluster of 19, not the pair beside it";
  EXPECT_DOUBLE_EQ(found.of.at(0, 0), 0.75);
  for (std::size_t c = 0; c < 20; ++c) {
    double sum = found.none[c];
    for (std::size_t r = 0; r < 20; ++r) {
      EXPECT_GE(found.of.at(r, c), 0.0);
      sum += found.of.at(r, c);
    }
    EXPECT_NEAR(sum, 1.0, 1e-9);
  }
  by_solving(joint, weights);
  EXPECT_EQ(joint.approximated(), 2u);

  // 70 observations of one track are no crowd: one track has them all.
  JointAssociation one(70, 1);
  Table lone(70, 1);
  std::fill(lone.values.begin(), lone.values.end(), 0.5);
  const Probabilities shared = by_solving(one, lone);
  EXPECT_NEAR(shared.of.at(69, 0), 0.5 / 36.0, 1e-15);
  EXPECT_EQ(one.approximated(), 0u);
}

// How far the approximation is off where both can be had: known, not hidden.
TEST(JointAssociation, TheApproximationIsNearWhereWeightsAreClear) {
  // Two tracks, an observation near each: 100 to its own, 2 to the other.
  Table weights(2, 2);
  weights.at(0, 0) = weights.at(1, 1) = 100.0;
  weights.at(0, 1) = weights.at(1, 0) = 2.0;
  const Probabilities exact = by_enumeration(weights);
  const double cheap = 100.0 / (1.0 + 100.0 + 2.0 + 2.0);
  EXPECT_NEAR(exact.of.at(0, 0), cheap, 0.04);
}

TEST(JointAssociation, TheOrderOfPairsDoesNotMatterToTheBit) {
  RandomStream stream({.seed = 4});
  JointAssociation joint(20, 20);
  for (const std::size_t size : {std::size_t{6}, std::size_t{20}}) {
    std::vector<Pair> pairs = drawn(stream, size, size, 0.7).pairs();
    joint.solve(pairs, size, size);
    std::vector<double> first;
    for (std::size_t c = 0; c < size; ++c)
      for (const auto& shared : joint.of_column(c)) first.push_back(shared.probability);
    std::reverse(pairs.begin(), pairs.end());
    joint.solve(pairs, size, size);
    std::vector<double> second;
    for (std::size_t c = 0; c < size; ++c)
      for (const auto& shared : joint.of_column(c)) second.push_back(shared.probability);
    EXPECT_EQ(first, second);
  }
}

TEST(JointAssociation, AllocatesNothingAfterConstruction) {
  RandomStream stream({.seed = 5});
  JointAssociation joint(30, 30);
  const std::vector<Pair> few = drawn(stream, 8, 9, 0.8).pairs(), many = drawn(stream, 30, 30, 1.0).pairs();
  const std::int64_t before = support::allocations();
  joint.solve(few, 8, 9);
  joint.solve(many, 30, 30);
  EXPECT_EQ(support::allocations() - before, 0);
}

}  // namespace
}  // namespace ttf::fusion::association
