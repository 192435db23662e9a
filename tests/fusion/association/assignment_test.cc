// The assignment is the best of all, found by trying all.
#include "fusion/association/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "core/random.h"

namespace ttf::fusion::association {
namespace {

// The largest sum of gains over all ways to leave a row alone or give it a free column.
double brute_force(const std::vector<std::vector<double>>& gain, std::size_t row, unsigned taken) {
  if (row == gain.size()) return 0.0;
  double best = brute_force(gain, row + 1, taken);
  for (std::size_t c = 0; c < gain[row].size(); ++c)
    if (gain[row][c] > 0.0 && !(taken >> c & 1u))
      best = std::max(best, gain[row][c] + brute_force(gain, row + 1, taken | 1u << c));
  return best;
}

// The sum of a solution's gains. Fails when a pair is no candidate or a column is given twice.
double value_of(const std::vector<std::vector<double>>& gain, std::span<const int> column_of) {
  double sum = 0.0;
  std::set<int> columns;
  for (std::size_t r = 0; r < column_of.size(); ++r) {
    if (column_of[r] < 0) continue;
    EXPECT_TRUE(columns.insert(column_of[r]).second) << "column " << column_of[r] << " twice";
    EXPECT_GT(gain[r][static_cast<std::size_t>(column_of[r])], 0.0) << "outside the gate";
    sum += gain[r][static_cast<std::size_t>(column_of[r])];
  }
  return sum;
}

TEST(Assignment, IsAsGoodAsTryingAllWays) {
  Assignment assignment(7, 7);  // one object for all: no state may survive a problem
  for (std::uint32_t index = 0; index < 3000; ++index) {
    RandomStream stream({.seed = 5, .purpose = Purpose::kTest, .index = index});
    const auto rows = static_cast<std::size_t>(stream.integer(0, 6)),
               columns = static_cast<std::size_t>(stream.integer(0, 7));
    const double density = stream.uniform();
    const bool ties = stream.uniform() < 0.3;
    std::vector<std::vector<double>> gain(rows, std::vector<double>(columns, 0.0));
    std::vector<Candidate> candidates;
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < columns; ++c) {
        if (stream.uniform() >= density) continue;
        gain[r][c] = ties ? static_cast<double>(stream.integer(1, 3)) : stream.uniform(1e-9, 120.0);
        candidates.push_back({static_cast<int>(r), static_cast<int>(c), gain[r][c]});
      }
    for (std::size_t i = candidates.size(); i > 1; --i)
      std::swap(candidates[i - 1],
                candidates[static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(i) - 1))]);
    assignment.solve(candidates, rows, columns);
    ASSERT_EQ(assignment.column_of().size(), rows);
    ASSERT_NEAR(value_of(gain, assignment.column_of()), brute_force(gain, 0, 0), 1e-9) << "problem " << index;
  }
}

TEST(Assignment, GreedyWouldBeWorse) {
  //            column 0   column 1
  //   row 0       9          8        greedy takes 9 and is left with 1
  //   row 1       8          1
  Assignment assignment(2, 2);
  assignment.solve(std::vector<Candidate>{{0, 0, 9.0}, {0, 1, 8.0}, {1, 0, 8.0}, {1, 1, 1.0}}, 2, 2);
  EXPECT_EQ(assignment.column_of()[0], 1);
  EXPECT_EQ(assignment.column_of()[1], 0);
}

TEST(Assignment, FullSizeDenseProblem) {
  // gain = 1000 - (r - c)^2 on 64 x 100: the diagonal is by far the best for every row.
  Assignment assignment(64, 100);
  std::vector<Candidate> candidates;
  for (int r = 0; r < 64; ++r)
    for (int c = 0; c < 100; ++c) candidates.push_back({r, c, 10000.0 - (r - c) * (r - c)});
  assignment.solve(candidates, 64, 100);
  for (int r = 0; r < 64; ++r) EXPECT_EQ(assignment.column_of()[static_cast<std::size_t>(r)], r);
}

}  // namespace
}  // namespace ttf::fusion::association
