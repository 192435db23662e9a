#include "fusion/association/assignment.h"

#include <algorithm>
#include <limits>

#include "core/check.h"

namespace ttf::fusion::association {
namespace {

// More than any gain, so that a pair outside its gate is never chosen over leaving the row alone (cost 0).
constexpr double kForbidden = 1e12;

}  // namespace

Assignment::Assignment(std::size_t max_rows, std::size_t max_columns)
    : max_rows_(max_rows), components_(max_rows + max_columns) {
  column_of_.resize(max_rows);
  component_rows_.reserve(max_rows);
  component_columns_.reserve(max_rows * max_columns);  // of every candidate, before they are made unique
  local_column_.resize(max_columns);
  sorted_.reserve(max_rows * max_columns);
  // Each row also has a column of its own that stands for "unassigned".
  const std::size_t width = max_columns + max_rows;
  cost_ = std::make_unique_for_overwrite<double[]>(max_rows * width);  // touched only as far as it is needed
  u_.resize(max_rows + 1);
  v_.resize(width + 1);
  shortest_.resize(width + 1);
  match_.resize(width + 1);
  way_.resize(width + 1);
  used_.resize(width + 1);
}

void Assignment::solve(std::span<const Candidate> candidates, std::size_t rows, std::size_t columns) {
  TTF_CHECK(rows <= max_rows_ && rows + columns <= components_.capacity(), "{} rows, {} columns", rows, columns);
  rows_ = rows;
  columns_ = columns;
  std::fill(column_of_.begin(), column_of_.begin() + static_cast<std::ptrdiff_t>(rows), -1);
  components_.reset(rows + columns);
  sorted_.assign(candidates.begin(), candidates.end());
  for (const Candidate& candidate : sorted_) components_.join(candidate.row, static_cast<int>(rows) + candidate.column);
  std::sort(sorted_.begin(), sorted_.end(), [&](const Candidate& a, const Candidate& b) {
    const int ra = components_.root(a.row), rb = components_.root(b.row);
    if (ra != rb) return ra < rb;
    return a.row != b.row ? a.row < b.row : a.column < b.column;
  });
  for (first_ = 0; first_ < sorted_.size(); first_ = last_) {
    const int component = components_.root(sorted_[first_].row);
    last_ = first_;
    while (last_ < sorted_.size() && components_.root(sorted_[last_].row) == component) ++last_;
    if (last_ - first_ == 1)
      column_of_[static_cast<std::size_t>(sorted_[first_].row)] = sorted_[first_].column;
    else
      solve_component();
  }
}

// Rows are inserted one by one along the shortest augmenting path; potentials u, v keep reduced costs
// non-negative.
void Assignment::solve_component() {
  component_rows_.clear();
  component_columns_.clear();
  for (std::size_t c = first_; c < last_; ++c) {
    if (component_rows_.empty() || component_rows_.back() != sorted_[c].row) component_rows_.push_back(sorted_[c].row);
    component_columns_.push_back(sorted_[c].column);
  }
  std::sort(component_columns_.begin(), component_columns_.end());
  component_columns_.erase(std::unique(component_columns_.begin(), component_columns_.end()), component_columns_.end());
  const std::size_t n = component_rows_.size(), tracks = component_columns_.size(), m = tracks + n;
  for (std::size_t j = 0; j < tracks; ++j)
    local_column_[static_cast<std::size_t>(component_columns_[j])] = static_cast<int>(j);
  std::fill_n(cost_.get(), n * m, kForbidden);
  for (std::size_t i = 0; i < n; ++i) cost_[i * m + tracks + i] = 0.0;
  std::size_t i = 0;
  for (std::size_t c = first_; c < last_; ++c) {
    while (component_rows_[i] != sorted_[c].row) ++i;
    cost_[i * m + static_cast<std::size_t>(local_column_[static_cast<std::size_t>(sorted_[c].column)])] =
        -sorted_[c].gain;
  }

  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::fill(u_.begin(), u_.begin() + static_cast<std::ptrdiff_t>(n + 1), 0.0);
  std::fill(v_.begin(), v_.begin() + static_cast<std::ptrdiff_t>(m + 1), 0.0);
  std::fill(match_.begin(), match_.begin() + static_cast<std::ptrdiff_t>(m + 1), 0);
  for (std::size_t row = 1; row <= n; ++row) {
    match_[0] = static_cast<int>(row);
    std::fill(shortest_.begin(), shortest_.begin() + static_cast<std::ptrdiff_t>(m + 1), kInfinity);
    std::fill(used_.begin(), used_.begin() + static_cast<std::ptrdiff_t>(m + 1), 0);
    std::size_t column = 0;
    do {
      used_[column] = 1;
      const auto current = static_cast<std::size_t>(match_[column]);
      double delta = kInfinity;
      std::size_t next = 0;
      for (std::size_t j = 1; j <= m; ++j) {
        if (used_[j]) continue;
        const double reduced = cost_[(current - 1) * m + j - 1] - u_[current] - v_[j];
        if (reduced < shortest_[j]) {
          shortest_[j] = reduced;
          way_[j] = static_cast<int>(column);
        }
        if (shortest_[j] < delta) {
          delta = shortest_[j];
          next = j;
        }
      }
      for (std::size_t j = 0; j <= m; ++j)
        if (used_[j]) {
          u_[static_cast<std::size_t>(match_[j])] += delta;
          v_[j] -= delta;
        } else {
          shortest_[j] -= delta;
        }
      column = next;
    } while (match_[column] != 0);
    while (column != 0) {
      const auto previous = static_cast<std::size_t>(way_[column]);
      match_[column] = match_[previous];
      column = previous;
    }
  }
  for (std::size_t j = 1; j <= tracks; ++j)
    if (match_[j] != 0)
      column_of_[static_cast<std::size_t>(component_rows_[static_cast<std::size_t>(match_[j] - 1)])] =
          component_columns_[j - 1];
}

}  // namespace ttf::fusion::association
