// One-to-one pairs of two lists at least cost, where a pair that is not offered, or not worth it, stays apart.
//
// The optimum is that of fusion/association/assignment.h, exact for dense and for square problems; with a pair's gain 1
// + bonus - cost it is the cut-off problem of GOSPA and OSPA, or the one that takes as many pairs as it can first.
// Laws:
//   P1  no set of one-to-one pairs of what was offered has a larger sum of gains (but for rounding, 1e-12 of the sum)
//   P2  equal sums: rows come in order and prefer small columns. Among pairs of exactly equal cost no row could move to
//       a smaller free column, no unpaired row could replace a later one, and no two rows could exchange columns so
//       that the earlier one gets the smaller.
//   P3  the pairs do not depend on the order of offers
// Storage is taken at construction; nothing is allocated afterwards.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fusion/association/assignment.h"

namespace ttf::fusion::metrics {

class Pairing {
 public:
  // Added to the gain of every pair. The small one decides between equal sums for more pairs.
  static constexpr double kLeastCost = 1e-12;
  // Large enough that no saving of cost makes up for a pair less.
  static double most_pairs(std::size_t rows, std::size_t columns) {
    return 1.0 + static_cast<double>(rows < columns ? rows : columns);
  }

  Pairing(std::size_t max_rows, std::size_t max_columns);

  void begin(std::size_t rows, std::size_t columns);
  // `cost` in [0, 1], 1 being the cut-off. A pair is offered once.
  void offer(std::size_t row, std::size_t column, double cost);
  void solve(double bonus);

  static constexpr int kNone = -1;
  std::span<const int> column_of() const { return {column_of_.data(), rows_}; }

 private:
  double& cost(std::size_t row, std::size_t column) { return cost_[row * columns_ + column]; }
  void settle_ties();
  bool prefer_smaller_column(std::size_t row);

  std::size_t max_rows_, max_columns_, rows_ = 0, columns_ = 0;
  std::vector<double> cost_;  // infinite where no pair was offered
  std::vector<association::Candidate> candidates_;
  std::vector<int> column_of_, row_of_;
  association::Assignment assignment_;
};

}  // namespace ttf::fusion::metrics
