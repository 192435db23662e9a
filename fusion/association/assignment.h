// Optimal assignment of observations to tracks (global nearest neighbour).
//
// The candidates are sparse: only pairs inside their gate. They fall into independent components. Shortest
// augmenting paths solve each component (Hungarian method with potentials: Kuhn 1955, Munkres 1957); an
// observation stays unassigned where that costs less. A pair of a row and a column without other candidates is assigned
// at once. The constructor allocates all storage; solving allocates nothing.
//
// In a component, cost(i, j) is the negative gain of row i in column j, 0 in the row's own column for
// "unassigned", and kForbidden elsewhere. Potentials u of rows and v of columns keep every reduced cost
//   cost(i, j) - u(i) - v(j)
// at 0 or above, and at 0 for matched pairs. A path of zeros from a row to a free column can swap its matched
// and unmatched pairs; the new matching is optimal with one row more.
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

  // Solves for the largest sum of gains. column_of()[row] is the row's column, or -1.
  void solve(std::span<const Candidate> candidates, std::size_t rows, std::size_t columns);
  std::span<const int> column_of() const { return {column_of_.data(), rows_}; }

 private:
  void assign_lone_pairs(std::span<const Candidate> candidates, std::size_t columns);
  void sort_by_component(std::size_t columns);
  void solve_component(std::span<const Candidate> component);
  void number_component(std::span<const Candidate> component);
  void fill_costs(std::span<const Candidate> component);
  std::size_t nearest_free_column();
  struct Near {
    std::size_t column;
    double distance;
  };
  Near nearest_from(std::size_t column);
  void move_potentials(double distance);
  void match_along_path(std::size_t column);
  // Returns the columns of the component plus one column for each row.
  std::size_t width() const { return component_columns_.size() + component_rows_.size(); }

  std::size_t rows_ = 0, max_rows_;
  std::vector<int> column_of_;
  Components components_;                // rows, then columns
  std::vector<int> of_row_, of_column_;  // how many candidates each has
  std::vector<Candidate> sorted_;        // by component, row, column: all but lone pairs

  // The component being solved. Its rows and columns are renumbered in ascending order. Behind its columns,
  // each row has a column for "unassigned".
  std::vector<int> component_rows_, component_columns_, local_column_;
  std::unique_ptr<double[]> cost_;  // by row, numbered from 0
  // The matching, with rows and columns numbered from 1. Row 0 means no row; column 0 holds the waiting row.
  std::vector<int> row_of_;  // by column
  std::vector<double> row_potential_, column_potential_;
  // The search for a free column.
  std::vector<char> reached_;
  std::vector<double> distance_;  // by unreached column, from the nearest reached one
  std::vector<int> before_;       // the column before each on its shortest path
};

}  // namespace ttf::fusion::association
