#include "fusion/association/assignment.h"

#include <algorithm>
#include <limits>

#include "core/check.h"
#include "core/ids.h"

namespace ttf::fusion::association {
namespace {

// Larger than any gain, so that leaving a row unassigned (cost 0) beats a pair outside its gate.
constexpr double kForbidden = 1e12;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

Assignment::Assignment(std::size_t max_rows, std::size_t max_columns)
    : max_rows_(max_rows), components_(max_rows + max_columns) {
  column_of_.resize(max_rows);
  of_row_.resize(max_rows);
  of_column_.resize(max_rows + max_columns);
  sorted_.reserve(max_rows * max_columns);
  component_rows_.reserve(max_rows);
  component_columns_.reserve(max_rows * max_columns);  // every candidate's, before duplicates go
  local_column_.resize(max_columns);
  const std::size_t width = max_columns + max_rows;
  cost_ = std::make_unique_for_overwrite<double[]>(max_rows * width);  // only the used part is touched
  row_potential_.resize(max_rows + 1);
  column_potential_.resize(width + 1);
  row_of_.resize(width + 1);
  reached_.resize(width + 1);
  distance_.resize(width + 1);
  before_.resize(width + 1);
}

void Assignment::solve(std::span<const Candidate> candidates, std::size_t rows, std::size_t columns) {
  TTF_CHECK(rows <= max_rows_ && rows + columns <= components_.capacity(), "{} rows, {} columns", rows, columns);
  rows_ = rows;
  std::fill_n(column_of_.begin(), rows, -1);
  assign_lone_pairs(candidates, columns);
  sort_by_component(columns);
  const std::span<const Candidate> sorted(sorted_);
  for (std::size_t first = 0, last = 0; first < sorted.size(); first = last) {
    const int component = components_.root(sorted[first].row);
    while (last < sorted.size() && components_.root(sorted[last].row) == component) ++last;
    if (last - first == 1)
      column_of_[index_of(sorted[first].row)] = sorted[first].column;
    else
      solve_component(sorted.subspan(first, last - first));
  }
}

void Assignment::assign_lone_pairs(std::span<const Candidate> candidates, std::size_t columns) {
  std::fill_n(of_row_.begin(), rows_, 0);
  std::fill_n(of_column_.begin(), columns, 0);
  for (const Candidate& candidate : candidates) {
    ++of_row_[index_of(candidate.row)];
    ++of_column_[index_of(candidate.column)];
  }
  sorted_.clear();
  for (const Candidate& candidate : candidates)
    if (of_row_[index_of(candidate.row)] == 1 && of_column_[index_of(candidate.column)] == 1)
      column_of_[index_of(candidate.row)] = candidate.column;
    else
      sorted_.push_back(candidate);
}

void Assignment::sort_by_component(std::size_t columns) {
  components_.reset(rows_ + columns);
  for (const Candidate& candidate : sorted_)
    components_.join(candidate.row, static_cast<int>(rows_) + candidate.column);
  const auto before = [&](const Candidate& a, const Candidate& b) {
    const int ra = components_.root(a.row), rb = components_.root(b.row);
    if (ra != rb) return ra < rb;
    return a.row != b.row ? a.row < b.row : a.column < b.column;
  };
  std::sort(sorted_.begin(), sorted_.end(), before);
}

// Adds the rows to the matching one by one.
void Assignment::solve_component(std::span<const Candidate> component) {
  number_component(component);
  fill_costs(component);
  std::fill_n(row_potential_.begin(), component_rows_.size() + 1, 0.0);
  std::fill_n(column_potential_.begin(), width() + 1, 0.0);
  std::fill_n(row_of_.begin(), width() + 1, 0);
  for (std::size_t row = 1; row <= component_rows_.size(); ++row) {
    row_of_[0] = static_cast<int>(row);
    match_along_path(nearest_free_column());
  }
  for (std::size_t j = 0; j < component_columns_.size(); ++j)
    if (const int row = row_of_[j + 1]; row != 0)
      column_of_[index_of(component_rows_[index_of(row - 1)])] = component_columns_[j];
}

void Assignment::number_component(std::span<const Candidate> component) {
  component_rows_.clear();
  component_columns_.clear();
  for (const Candidate& candidate : component) {
    if (component_rows_.empty() || component_rows_.back() != candidate.row) component_rows_.push_back(candidate.row);
    component_columns_.push_back(candidate.column);
  }
  std::sort(component_columns_.begin(), component_columns_.end());
  component_columns_.erase(std::unique(component_columns_.begin(), component_columns_.end()), component_columns_.end());
  for (std::size_t j = 0; j < component_columns_.size(); ++j)
    local_column_[index_of(component_columns_[j])] = static_cast<int>(j);
}

void Assignment::fill_costs(std::span<const Candidate> component) {
  const std::size_t rows = component_rows_.size(), tracks = component_columns_.size();
  std::fill_n(cost_.get(), rows * width(), kForbidden);
  for (std::size_t i = 0; i < rows; ++i) cost_[i * width() + tracks + i] = 0.0;
  std::size_t i = 0;
  for (const Candidate& candidate : component) {
    while (component_rows_[i] != candidate.row) ++i;
    cost_[i * width() + index_of(local_column_[index_of(candidate.column)])] = -candidate.gain;
  }
}

// Searches from the waiting row along shortest paths (Dijkstra). The potentials move along, so that the path's
// reduced costs are 0.
std::size_t Assignment::nearest_free_column() {
  std::fill_n(reached_.begin(), width() + 1, 0);
  std::fill_n(distance_.begin(), width() + 1, kInfinity);
  std::size_t column = 0;
  do {
    reached_[column] = 1;
    const Near next = nearest_from(column);
    move_potentials(next.distance);
    column = next.column;
  } while (row_of_[column] != 0);
  return column;
}

// Updates the distances over this column's row; returns the nearest column that is not reached.
Assignment::Near Assignment::nearest_from(std::size_t column) {
  const std::size_t columns = width();
  const std::size_t row = index_of(row_of_[column]);
  Near nearest{0, kInfinity};
  for (std::size_t j = 1; j <= columns; ++j) {
    if (reached_[j]) continue;
    const double reduced = cost_[(row - 1) * columns + j - 1] - row_potential_[row] - column_potential_[j];
    if (reduced < distance_[j]) {
      distance_[j] = reduced;
      before_[j] = static_cast<int>(column);
    }
    if (distance_[j] < nearest.distance) nearest = {j, distance_[j]};
  }
  return nearest;
}

// Brings all reached columns nearer by `distance`.
void Assignment::move_potentials(double distance) {
  const std::size_t columns = width();
  for (std::size_t j = 0; j <= columns; ++j)
    if (reached_[j]) {
      row_potential_[index_of(row_of_[j])] += distance;
      column_potential_[j] -= distance;
    } else {
      distance_[j] -= distance;
    }
}

// Gives each column the row of the column before it; the first column gets the waiting row.
void Assignment::match_along_path(std::size_t column) {
  while (column != 0) {
    const auto previous = index_of(before_[column]);
    row_of_[column] = row_of_[previous];
    column = previous;
  }
}

}  // namespace ttf::fusion::association
