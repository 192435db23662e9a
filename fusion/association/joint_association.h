// The probability that an observation belongs to a track, over all joint events. An event gives each
// observation to one track or to none, and each track one observation or none. This is joint probabilistic data
// association (Fortmann, Bar-Shalom, Scheffe: "Sonar tracking of multiple targets using joint probabilistic
// data association", IEEE J. Oceanic Eng. 8(3), 1983; Bar-Shalom, Fortmann: "Tracking and Data Association",
// 1988, 9.3).
//
// An event's probability is proportional to the product of its pairs' weights. The weight w > 0 is the
// probability of the pair relative to both alone, the observation as clutter and the track unseen:
//   P(event) = prod w / sum over all events of prod w.
// Only pairs with overlapping gates interact: observations and tracks fall into clusters that are solved one by
// one.
//
// A cluster of s tracks and l >= s observations, or the other way round, is solved exactly while (l + 1) 2^s <=
// 65536. The sum may have s! events or more. Forward and backward passes build it over the subsets of the s
// that are taken, one of the l at a time; all terms are positive. Larger clusters use "cheap JPDA" (Fitzgerald:
// "Development of practical PDA logic for multitarget tracking by microprocessor", ACC 1986). With S the sums
// of weights over a row and a column:
//   P(pair) = w / (S_row + S_column - w + 1).
// This is exact for a track or an observation without rivals. approximated() counts such clusters.
//
// The constructor allocates all storage; solving allocates nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fusion/association/components.h"

namespace ttf::fusion::association {

// Row: observation; column: track. The weight is above 0 and at most kLargestWeight.
struct Pair {
  int row = 0;
  int column = 0;
  double weight = 0.0;
};

class JointAssociation {
 public:
  // Keeps every sum from overflowing.
  static constexpr double kLargestWeight = 1e20;
  static constexpr std::size_t kLargestTable = 65536;

  JointAssociation(std::size_t max_rows, std::size_t max_columns);

  // Takes each pair at most once, in any order.
  void solve(std::span<const Pair> pairs, std::size_t rows, std::size_t columns);

  struct Shared {
    int row = 0;
    double probability = 0.0;
  };
  // The result of the last solve(): a track's possible observations in ascending order, and the probability of
  // none.
  std::span<const Shared> of_column(std::size_t column) const {
    return {shared_.data() + begin_[column], shared_.data() + begin_[column + 1]};
  }
  double none_of_column(std::size_t column) const { return none_[column]; }

  // Returns the number of approximated clusters since construction.
  std::uint64_t approximated() const { return approximated_; }

 private:
  struct Sorted {
    Pair pair;
    int cluster = 0;
    double probability = 0.0;
  };
  // The subsets for exact solving. The fewer of rows and columns are the bits of a set; each of the others is a
  // step that takes one bit or none. Both are numbered in ascending order.
  struct Subsets {
    bool columns_are_bits;
    std::size_t bits, steps, sets;
  };
  void sort_into_clusters(std::span<const Pair> pairs, std::size_t columns);
  void share_by_column(std::size_t columns);
  void solve_cluster(std::span<Sorted> cluster);
  void list_nodes(std::span<const Sorted> cluster);
  void solve_exactly(std::span<Sorted> cluster, const Subsets& subsets);
  void number_nodes();
  std::size_t place_of(const Pair& pair, const Subsets& subsets) const;
  void go_forward(const Subsets& subsets);
  double weigh_all(const Subsets& subsets);
  void go_backward(const Subsets& subsets, double all);
  void solve_cheaply(std::span<Sorted> cluster);

  std::size_t rows_ = 0;
  Components components_;                                    // rows, then columns
  std::vector<Sorted> sorted_;                               // by cluster, row, column; in the end by column, row
  std::vector<int> cluster_rows_, cluster_columns_, local_;  // local_: of rows, then of columns
  std::vector<double> weights_;                              // by step and bit; after go_backward() probabilities
  std::vector<double> forward_;                              // F, by step and set
  std::vector<double> backward_;                             // B of one step, by set
  std::vector<double> row_sums_, column_sums_;
  std::vector<double> none_;        // by column
  std::vector<Shared> shared_;      // by column, row
  std::vector<std::size_t> begin_;  // in shared_, by column
  std::uint64_t approximated_ = 0;
};

}  // namespace ttf::fusion::association
