// The distance of a set of estimates from the set of true objects, as one number and its parts.
//
// GOSPA with alpha = 2 (Rahmathullah, Garcia-Fernandez, Svensson: "Generalized optimal sub-pattern assignment metric",
// FUSION 2017, proposition 1): over all one-to-one pairs g of X (truth) and Y (estimates),
//   d = min_g ( sum_(i,j) in g d(x_i, y_j)^p  +  c^p / 2 (|X| - |g|)  +  c^p / 2 (|Y| - |g|) )^(1/p):
// localisation error, missed objects, false estimates. It grows with the number of objects.
//
// OSPA (Schuhmacher, Vo, Vo: "A consistent metric for performance evaluation of multi-object filters", IEEE TSP 56(8),
// 2008, section III): with m the smaller and n > 0 the larger number of points,
//   d = ( 1/n ( min_pi sum_i min(c, d(x_i, y_pi(i)))^p  +  c^p (n - m) ) )^(1/p).
// It lies between 0 and c, and is 0 if both sets are empty. GOSPA's pairs nearer than c are optimal for OSPA,
// too: any further pair costs c^p in one sum, and half of it twice in the other.
//
// Both are metrics on finite sets of points: identity, symmetry, triangle inequality. Parts are p-th powers
// [m^p], so they add up. Pairs at or beyond the cut-off c, and points that are not finite, stay apart. Among
// equal sums the one with more pairs counts, so the parts are unique; savings below 1e-12 c^p per pair are
// ignored.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fusion/metrics/cut_off.h"
#include "fusion/metrics/near_pairs.h"
#include "fusion/metrics/point.h"
#include "fusion/metrics/sparse_pairs.h"

namespace ttf::fusion::metrics {

struct Gospa {
  double distance_m = 0.0;
  double localisation = 0.0, missed = 0.0, false_estimates = 0.0;  // [m^p]; their sum is distance_m^p
};

struct Ospa {
  double distance_m = 0.0;
  double localisation = 0.0, cardinality = 0.0;  // [m^p]; their sum is distance_m^p
};

struct SetDistance {
  Gospa gospa;
  Ospa ospa;
  std::size_t pairs = 0;  // nearer than the cut-off
};

class SetMetric {
 public:
  explicit SetMetric(const CutOff& cut_off);

  // The storage grows with the largest sets and is kept.
  SetDistance between(std::span<const Point> truths, std::span<const Point> estimates);
  // Returns the estimate of each truth in the last two sets, or SparsePairs::kNone.
  std::span<const int> estimate_of() const { return pairs_.column_of(); }

  const CutOff& cut_off() const { return cut_off_; }
  // The p-th power, and its inverse.
  double power(double base) const;
  double root(double sum) const;

 private:
  CutOff cut_off_;
  NearPairs near_;
  SparsePairs pairs_;
};

}  // namespace ttf::fusion::metrics
