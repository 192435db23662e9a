#include "fusion/metrics/sparse_pairs.h"

#include <algorithm>
#include <tuple>

#include "core/check.h"
#include "core/ids.h"

namespace ttf::fusion::metrics {
namespace {

std::size_t place_of(const std::vector<int>& ascending, int value) {
  return static_cast<std::size_t>(std::lower_bound(ascending.begin(), ascending.end(), value) - ascending.begin());
}

void sort_and_unify(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

void SparsePairs::begin(std::size_t rows, std::size_t columns) {
  rows_ = rows;
  columns_ = columns;
  offers_.clear();
  if (rows + columns > components_.capacity()) components_ = association::Components(2 * (rows + columns));
  components_.reset(rows + columns);
}

void SparsePairs::offer(std::size_t row, std::size_t column, double cost) {
  TTF_CHECK(row < rows_ && column < columns_, "row {} of {}, column {} of {}", row, rows_, column, columns_);
  TTF_CHECK(cost >= 0.0 && cost <= 1.0, "row {} column {} cost {}", row, column, cost);
  components_.join(static_cast<int>(row), static_cast<int>(rows_ + column));
  offers_.push_back({0, static_cast<int>(row), static_cast<int>(column), cost});
}

void SparsePairs::solve(Best best) {
  column_of_.assign(rows_, kNone);
  for (Offer& offer : offers_) offer.component = components_.root(offer.row);
  std::sort(offers_.begin(), offers_.end(), [](const Offer& a, const Offer& b) {
    return std::tie(a.component, a.row, a.column) < std::tie(b.component, b.row, b.column);
  });
  const std::span<const Offer> offers(offers_);
  for (std::size_t first = 0, last = 0; first < offers.size(); first = last) {
    while (last < offers.size() && offers[last].component == offers[first].component) ++last;
    if (last - first == 1)
      column_of_[index_of(offers[first].row)] = offers[first].column;
    else
      solve_component(offers.subspan(first, last - first), best);
  }
}

void SparsePairs::solve_component(std::span<const Offer> offers, Best best) {
  component_rows_.clear();
  component_columns_.clear();
  for (const Offer& offer : offers) {
    component_rows_.push_back(offer.row);
    component_columns_.push_back(offer.column);
  }
  sort_and_unify(component_rows_);
  sort_and_unify(component_columns_);
  const std::size_t rows = component_rows_.size(), columns = component_columns_.size();
  if (rows > most_rows_ || columns > most_columns_) {
    most_rows_ = std::max(most_rows_, rows + rows / 2);
    most_columns_ = std::max(most_columns_, columns + columns / 2);
    pairs_ = LeastCostPairs(most_rows_, most_columns_);
  }
  pairs_.begin(rows, columns);
  for (const Offer& offer : offers)
    pairs_.offer(place_of(component_rows_, offer.row), place_of(component_columns_, offer.column), offer.cost);
  pairs_.solve(best == Best::kMostPairs ? LeastCostPairs::most_pairs(rows, columns) : LeastCostPairs::kLeastCost);
  for (std::size_t row = 0; row < rows; ++row)
    if (const int column = pairs_.column_of()[row]; column != kNone)
      column_of_[index_of(component_rows_[row])] = component_columns_[index_of(column)];
}

}  // namespace ttf::fusion::metrics
