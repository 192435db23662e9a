// Finds all pairs of two sets of points within a distance. Sorting into squares of that size spares most
// comparisons: n points apart from each other take about n log n steps.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fusion/metrics/point.h"

namespace ttf::fusion::metrics {

struct NearPair {
  std::size_t row = 0, column = 0;  // a point of the first set and one of the second
  double distance_m = 0.0;
};

class NearPairs {
 public:
  // Returns the pairs no further apart than `within_m` (>= 0), in no particular order, valid until the next call.
  // Points that are not finite have no pairs. The storage grows with the largest sets and is kept.
  std::span<const NearPair> find(std::span<const Point> rows, std::span<const Point> columns, double within_m);

 private:
  struct Place {
    double column, row;  // a square's
    std::size_t point;
  };
  void try_all(std::span<const Point> rows, std::span<const Point> columns);
  void try_near(std::span<const Point> rows, std::span<const Point> columns);
  void try_one(std::span<const Point> rows, std::span<const Point> columns, std::size_t row, std::size_t column);

  double within_ = 0.0;
  std::vector<Place> places_;
  std::vector<NearPair> found_;
};

}  // namespace ttf::fusion::metrics
