// Pairs two sets one to one at least cost. A pair that is not offered, or too costly, stays apart.
//
// The optimum is that of fusion/association/assignment.h, exact for dense and for square problems. With a
// pair's gain 1 + bonus - cost it solves the cut-off problem of GOSPA and OSPA, or first takes as many pairs as
// possible. Laws:
//   P1  No set of one-to-one offered pairs has a larger sum of gains, up to rounding, 1e-12 of the sum.
//   P2  For equal sums, rows prefer small columns, in order. Among pairs of exactly equal cost no row could move to a
//       smaller free column, no unpaired row could replace a later one, and no two rows could exchange columns so
//       that the earlier one gets the smaller.
//   P3  The pairs do not depend on the order of offers.
// The constructor allocates all storage.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fusion/association/assignment.h"

namespace ttf::fusion::metrics {

class LeastCostPairs {
 public:
  // Bonuses, added to the gain of every pair. The small one prefers more pairs among equal sums.
  static constexpr double kLeastCost = 1e-12;
  // Large enough to outweigh any saving of cost by one pair less.
  static double most_pairs(std::size_t rows, std::size_t columns) {
    return 1.0 + static_cast<double>(rows < columns ? rows : columns);
  }

  LeastCostPairs(std::size_t max_rows, std::size_t max_columns);

  void begin(std::size_t rows, std::size_t columns);
  // Offers a pair, once. `cost` is in [0, 1]; 1 is the cut-off.
  void offer(std::size_t row, std::size_t column, double cost);
  void solve(double bonus);

  static constexpr int kNone = -1;
  std::span<const int> column_of() const { return {column_of_.data(), rows_}; }

 private:
  double& cost(std::size_t row, std::size_t column) { return cost_[row * columns_ + column]; }
  void settle_ties();
  bool prefer_smaller_column(std::size_t row);

  std::size_t max_rows_, max_columns_, rows_ = 0, columns_ = 0;
  std::vector<double> cost_;  // infinite without an offer
  std::vector<association::Candidate> candidates_;
  std::vector<int> column_of_, row_of_;
  association::Assignment assignment_;
};

}  // namespace ttf::fusion::metrics
