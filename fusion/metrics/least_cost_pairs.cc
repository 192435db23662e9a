#include "fusion/metrics/least_cost_pairs.h"

#include <algorithm>
#include <limits>

#include "core/check.h"

namespace ttf::fusion::metrics {

LeastCostPairs::LeastCostPairs(std::size_t max_rows, std::size_t max_columns)
    : max_rows_(max_rows), max_columns_(max_columns), cost_(max_rows * max_columns), column_of_(max_rows),
      row_of_(max_columns), assignment_(max_rows, max_columns) {
  candidates_.reserve(max_rows * max_columns);
}

void LeastCostPairs::begin(std::size_t rows, std::size_t columns) {
  TTF_CHECK(rows <= max_rows_ && columns <= max_columns_, "{} x {} of at most {} x {}", rows, columns, max_rows_,
            max_columns_);
  rows_ = rows;
  columns_ = columns;
  candidates_.clear();
  std::fill_n(cost_.begin(), rows * columns, std::numeric_limits<double>::infinity());
}

void LeastCostPairs::offer(std::size_t row, std::size_t column, double relative_cost) {
  TTF_CHECK(row < rows_ && column < columns_, "row {} of {}, column {} of {}", row, rows_, column, columns_);
  TTF_CHECK(relative_cost >= 0.0 && relative_cost <= 1.0, "row {} column {} cost {}", row, column, relative_cost);
  TTF_CHECK(cost(row, column) > 1.0, "row {} column {} offered again", row, column);
  cost(row, column) = relative_cost;
  candidates_.push_back({static_cast<int>(row), static_cast<int>(column), 0.0});
}

void LeastCostPairs::solve(double bonus) {
  TTF_CHECK(bonus > 0.0, "bonus {}", bonus);
  for (association::Candidate& pair : candidates_)
    pair.gain = bonus + (1.0 - cost(static_cast<std::size_t>(pair.row), static_cast<std::size_t>(pair.column)));
  assignment_.solve(candidates_, rows_, columns_);
  std::fill_n(row_of_.begin(), columns_, kNone);
  for (std::size_t row = 0; row < rows_; ++row) {
    column_of_[row] = assignment_.column_of()[row];
    if (column_of_[row] != kNone) row_of_[static_cast<std::size_t>(column_of_[row])] = static_cast<int>(row);
  }
  settle_ties();
}

// Ends, because every change makes the sequence of columns smaller, in lexicographic order with kNone as the
// largest.
void LeastCostPairs::settle_ties() {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t row = 0; row < rows_; ++row)
      while (prefer_smaller_column(row)) changed = true;
  }
}

bool LeastCostPairs::prefer_smaller_column(std::size_t row) {
  const int now = column_of_[row];
  const std::size_t end = now == kNone ? columns_ : static_cast<std::size_t>(now);
  for (std::size_t column = 0; column < end; ++column) {
    const double wanted = cost(row, column);
    if (wanted > 1.0) continue;
    const int owner = row_of_[column];
    if (owner == kNone) {
      if (now == kNone || wanted != cost(row, end)) continue;
    } else {
      const auto other = static_cast<std::size_t>(owner);
      if (other < row) continue;
      const double given_up = cost(other, column);
      if (now == kNone ? wanted != given_up : wanted + cost(other, end) != cost(row, end) + given_up) continue;
      column_of_[other] = now;
    }
    if (now != kNone) row_of_[end] = owner;
    column_of_[row] = static_cast<int>(column);
    row_of_[column] = static_cast<int>(row);
    return true;
  }
  return false;
}

}  // namespace ttf::fusion::metrics
