// Pairs two large sets one to one at least cost, where most pairs are out of the question.
//
// The offered pairs fall into connected components, which LeastCostPairs solves one by one, with its laws P1 to P3. A
// component of k rows and columns takes about k^3 steps, a pair that shares no point with another one a single step.
// So n well separated objects cost the sorting of their pairs, n log n.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fusion/association/components.h"
#include "fusion/metrics/least_cost_pairs.h"

namespace ttf::fusion::metrics {

// The aim: the least cost, where a point left apart costs half of the cut-off; or as many pairs as possible, and then
// the least cost.
enum class Best : bool { kLeastCost, kMostPairs };

class SparsePairs {
 public:
  SparsePairs() : components_(0), pairs_(0, 0) {}

  void begin(std::size_t rows, std::size_t columns);
  // Offers a pair, once. `cost` is in [0, 1]; 1 is the cut-off.
  void offer(std::size_t row, std::size_t column, double cost);
  // The storage grows with the largest problem and is kept.
  void solve(Best best);

  static constexpr int kNone = LeastCostPairs::kNone;
  std::span<const int> column_of() const { return column_of_; }

 private:
  struct Offer {
    int component, row, column;
    double cost;
  };
  void solve_component(std::span<const Offer> offers, Best best);

  std::size_t rows_ = 0, columns_ = 0, most_rows_ = 0, most_columns_ = 0;
  std::vector<Offer> offers_;
  association::Components components_;  // rows, then columns
  LeastCostPairs pairs_;                // for up to most_rows_ x most_columns_
  std::vector<int> column_of_;
  std::vector<int> component_rows_, component_columns_;  // those being solved, ascending
};

}  // namespace ttf::fusion::metrics
