// Optimal assignment of observations to tracks (global nearest neighbour).
//
// The candidates are sparse: only pairs inside their gate. They fall into independent components that are
// solved one by one with shortest augmenting paths (Hungarian method with potentials: Kuhn 1955, Munkres
// 1957), which leaves an observation unassigned where that is cheaper. Storage is taken at construction;
// solving allocates nothing.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "fusion/association/components.h"

namespace ttf::fusion::association {

// Assigning observation `row` to track `column` gains `gain` > 0 over leaving both alone.
struct Candidate {
  int row = 0;
  int column = 0;
  double gain = 0.0;
};

class Assignment {
 public:
  Assignment(std::size_t max_rows, std::size_t max_columns);

  // column_of()[row] is the column of each row, -1 for none; the sum of gains is the largest possible.
  void solve(std::span<const Candidate> candidates, std::size_t rows, std::size_t columns);
  std::span<const int> column_of() const { return {column_of_.data(), rows_}; }

 private:
  void solve_component();

  std::size_t rows_ = 0, columns_ = 0, max_rows_;
  std::vector<int> column_of_;
  Components components_;  // of rows, then columns
  std::vector<int> component_rows_, component_columns_, local_column_;
  std::vector<Candidate> sorted_;
  std::size_t first_ = 0, last_ = 0;  // candidates of the component being solved
  std::unique_ptr<double[]> cost_;
  std::vector<double> u_, v_, shortest_;
  std::vector<int> match_, way_;
  std::vector<char> used_;
};

}  // namespace ttf::fusion::association
