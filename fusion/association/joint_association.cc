#include "fusion/association/joint_association.h"

#include <algorithm>

#include "core/check.h"
#include "core/ids.h"

namespace ttf::fusion::association {
namespace {

void sort_unique(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

// The largest s with (s + 1) 2^s within the table: an exact cluster has at most s rows or at most s columns.
constexpr std::size_t most_bits() {
  std::size_t bits = 1;
  while ((bits + 2) << (bits + 1) <= JointAssociation::kLargestTable) ++bits;
  return bits;
}

// Returns the size of the tables; without rows or columns they are empty.
std::size_t table_of(std::size_t max_rows, std::size_t max_columns) {
  return max_rows == 0 || max_columns == 0 ? 0 : JointAssociation::kLargestTable;
}

}  // namespace

JointAssociation::JointAssociation(std::size_t max_rows, std::size_t max_columns)
    : components_(max_rows + max_columns), local_(max_rows + max_columns), weights_(table_of(max_rows, max_columns)),
      forward_(weights_.size()), backward_(std::min(weights_.size(), std::size_t{1} << most_bits())),
      row_sums_(max_rows), column_sums_(max_columns), none_(max_columns), begin_(max_columns + 1) {
  const std::size_t most = max_rows * max_columns;
  sorted_.reserve(most);
  shared_.reserve(most);
  cluster_rows_.reserve(most);  // every pair's, before duplicates go
  cluster_columns_.reserve(most);
}

void JointAssociation::solve(std::span<const Pair> pairs, std::size_t rows, std::size_t columns) {
  TTF_CHECK(rows <= row_sums_.size() && columns <= none_.size() && pairs.size() <= sorted_.capacity(),
            "{} pairs of {} rows, {} columns", pairs.size(), rows, columns);
  rows_ = rows;
  sort_into_clusters(pairs, columns);
  std::fill_n(none_.begin(), columns, 1.0);
  for (std::size_t first = 0, last = 0; first < sorted_.size(); first = last) {
    while (last < sorted_.size() && sorted_[last].cluster == sorted_[first].cluster) ++last;
    solve_cluster({sorted_.data() + first, last - first});
  }
  share_by_column(columns);
}

void JointAssociation::sort_into_clusters(std::span<const Pair> pairs, std::size_t columns) {
  components_.reset(rows_ + columns);
  for (const Pair& pair : pairs) components_.join(pair.row, static_cast<int>(rows_) + pair.column);
  sorted_.clear();
  for (const Pair& pair : pairs) {
    TTF_CHECK(pair.weight > 0.0 && pair.weight <= kLargestWeight, "a weight of {}", pair.weight);
    sorted_.push_back({pair, components_.root(pair.row), 0.0});
  }
  std::sort(sorted_.begin(), sorted_.end(), [](const Sorted& a, const Sorted& b) {
    if (a.cluster != b.cluster) return a.cluster < b.cluster;
    return a.pair.row != b.pair.row ? a.pair.row < b.pair.row : a.pair.column < b.pair.column;
  });
}

void JointAssociation::share_by_column(std::size_t columns) {
  std::sort(sorted_.begin(), sorted_.end(), [](const Sorted& a, const Sorted& b) {
    return a.pair.column != b.pair.column ? a.pair.column < b.pair.column : a.pair.row < b.pair.row;
  });
  shared_.clear();
  std::size_t next = 0;
  for (std::size_t column = 0; column < columns; ++column) {
    begin_[column] = next;
    for (; next < sorted_.size() && index_of(sorted_[next].pair.column) == column; ++next)
      shared_.push_back({sorted_[next].pair.row, sorted_[next].probability});
  }
  begin_[columns] = next;
}

void JointAssociation::solve_cluster(std::span<Sorted> cluster) {
  if (cluster.size() == 1) {
    Sorted& only = cluster.front();
    only.probability = only.pair.weight / (1.0 + only.pair.weight);
    none_[index_of(only.pair.column)] = 1.0 / (1.0 + only.pair.weight);
    return;
  }
  list_nodes(cluster);
  const std::size_t bits = std::min(cluster_rows_.size(), cluster_columns_.size());
  const std::size_t steps = std::max(cluster_rows_.size(), cluster_columns_.size());
  if (bits <= most_bits() && (steps + 1) << bits <= kLargestTable) {
    const bool columns_are_bits = cluster_columns_.size() <= cluster_rows_.size();
    solve_exactly(cluster, {columns_are_bits, bits, steps, std::size_t{1} << bits});
  } else {
    solve_cheaply(cluster);
    ++approximated_;
  }
}

void JointAssociation::list_nodes(std::span<const Sorted> cluster) {
  cluster_rows_.clear();
  cluster_columns_.clear();
  for (const Sorted& one : cluster) {
    cluster_rows_.push_back(one.pair.row);
    cluster_columns_.push_back(one.pair.column);
  }
  sort_unique(cluster_rows_);
  sort_unique(cluster_columns_);
}

// With w(i, k) of step i and bit k, and T a set of bits:
//   forward:   F_0 = 1 for the empty set,  F_i+1(T) = F_i(T) + sum_(k in T) w(i, k) F_i(T - k),
//              all ways in which the first i steps take exactly T;
//   backward:  B_n = 1,  B_i(T) = B_i+1(T) + sum_(k not in T) w(i, k) B_i+1(T + k),
//              all ways in which the other steps continue after T.
// The weight of all events is sum_T F_n(T). The events in which step i takes bit k weigh
//   sum_(T without k) F_i(T) w(i, k) B_i+1(T + k).
void JointAssociation::solve_exactly(std::span<Sorted> cluster, const Subsets& subsets) {
  number_nodes();
  std::fill_n(weights_.begin(), subsets.steps * subsets.bits, 0.0);
  for (const Sorted& one : cluster) weights_[place_of(one.pair, subsets)] = one.pair.weight;
  go_forward(subsets);
  const double all = weigh_all(subsets);
  go_backward(subsets, all);
  for (Sorted& one : cluster) one.probability = weights_[place_of(one.pair, subsets)];
}

void JointAssociation::number_nodes() {
  for (std::size_t r = 0; r < cluster_rows_.size(); ++r) local_[index_of(cluster_rows_[r])] = static_cast<int>(r);
  for (std::size_t c = 0; c < cluster_columns_.size(); ++c)
    local_[rows_ + index_of(cluster_columns_[c])] = static_cast<int>(c);
}

std::size_t JointAssociation::place_of(const Pair& pair, const Subsets& subsets) const {
  const std::size_t row = index_of(local_[index_of(pair.row)]);
  const std::size_t column = index_of(local_[rows_ + index_of(pair.column)]);
  return subsets.columns_are_bits ? row * subsets.bits + column : column * subsets.bits + row;
}

// Computes F of all steps.
void JointAssociation::go_forward(const Subsets& subsets) {
  const std::size_t bits = subsets.bits, sets = subsets.sets;
  std::fill_n(forward_.begin(), sets, 0.0);
  forward_[0] = 1.0;
  for (std::size_t i = 0; i < subsets.steps; ++i) {
    const double *w = &weights_[i * bits], *from = &forward_[i * sets];
    double* to = &forward_[(i + 1) * sets];
    for (std::size_t taken = 0; taken < sets; ++taken) {
      double sum = from[taken];
      for (std::size_t k = 0; k < bits; ++k)
        if (taken >> k & 1u) sum += w[k] * from[taken ^ (std::size_t{1} << k)];
      to[taken] = sum;
    }
  }
}

// Returns the weight of all events. If tracks are bits, a track has no observation in events that end in a set
// without its bit.
double JointAssociation::weigh_all(const Subsets& subsets) {
  const double* complete = &forward_[subsets.steps * subsets.sets];
  double all = 0.0;
  for (std::size_t taken = 0; taken < subsets.sets; ++taken) all += complete[taken];
  if (!subsets.columns_are_bits) return all;
  for (std::size_t k = 0; k < subsets.bits; ++k) {
    double without = 0.0;
    for (std::size_t taken = 0; taken < subsets.sets; ++taken)
      if (!(taken >> k & 1u)) without += complete[taken];
    none_[index_of(cluster_columns_[k])] = without / all;
  }
  return all;
}

// Computes B step by step, the last step first, and replaces the weights by probabilities. If tracks are steps,
// a track has no observation in events whose step takes no bit: sum_T F_i(T) B_i+1(T).
void JointAssociation::go_backward(const Subsets& subsets, double all) {
  const std::size_t bits = subsets.bits, sets = subsets.sets;
  std::fill_n(backward_.begin(), sets, 1.0);
  for (std::size_t i = subsets.steps; i-- > 0;) {
    double* w = &weights_[i * bits];
    const double* before = &forward_[i * sets];
    if (!subsets.columns_are_bits) {
      double alone = 0.0;
      for (std::size_t taken = 0; taken < sets; ++taken) alone += before[taken] * backward_[taken];
      none_[index_of(cluster_columns_[i])] = alone / all;
    }
    double shares[most_bits()] = {};
    for (std::size_t taken = 0; taken < sets; ++taken) {
      double sum = backward_[taken];
      for (std::size_t k = 0; k < bits; ++k) {
        if (taken >> k & 1u) continue;
        const double onward = w[k] * backward_[taken | (std::size_t{1} << k)];
        shares[k] += before[taken] * onward;
        sum += onward;
      }
      backward_[taken] = sum;  // only larger sets need B_i+1 from here on
    }
    for (std::size_t k = 0; k < bits; ++k) w[k] = shares[k] / all;
  }
}

void JointAssociation::solve_cheaply(std::span<Sorted> cluster) {
  for (const int row : cluster_rows_) row_sums_[index_of(row)] = 0.0;
  for (const int column : cluster_columns_) column_sums_[index_of(column)] = 0.0;
  for (const Sorted& one : cluster) {
    row_sums_[index_of(one.pair.row)] += one.pair.weight;
    column_sums_[index_of(one.pair.column)] += one.pair.weight;
  }
  for (Sorted& one : cluster) {
    const double w = one.pair.weight;
    const double others = (row_sums_[index_of(one.pair.row)] - w) + (column_sums_[index_of(one.pair.column)] - w);
    one.probability = w / (1.0 + w + std::max(0.0, others));
    none_[index_of(one.pair.column)] -= one.probability;
  }
  for (const int column : cluster_columns_) none_[index_of(column)] = std::max(0.0, none_[index_of(column)]);
}

}  // namespace ttf::fusion::association
