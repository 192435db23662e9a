// Merges two normal distributions of one state into mean and covariance of their mixture. With weights a and b
// and d = x_b - x_a:
//   x <- x_a + b / (a + b) d,   P <- (a P_a + b P_b) / (a + b) + a b / (a + b)^2 d d'.
// The result is positive semi-definite, and symmetric to the bit if both inputs are. Repeated merging gives the
// moments of all (Salmond: "Mixture reduction algorithms for target tracking in clutter", SPIE 1305, 1990),
// with angles treated as angles.
#pragma once

#include "fusion/motion/kernels.h"
#include "fusion/motion/motion_model.h"

namespace ttf::fusion::filters {

// Takes weights that are not negative and not both zero; a weight of zero leaves the other distribution as it
// is.
template <motion::Model M>
void merge(linear::Gaussian<M::kStates>& first, double a, const linear::Gaussian<M::kStates>& second, double b) {
  constexpr int kN = M::kStates;
  if (b <= 0.0) return;
  if (a <= 0.0) {
    first = second;
    return;
  }
  const double share = b / (a + b);
  const linear::Vector<kN> d = M::difference(second.x, first.x);
  first.x += share * d;
  M::normalise(first.x);
  for (int c = 0; c < kN; ++c)
    for (int r = 0; r < kN; ++r) first.p(r, c) += share * (second.p(r, c) - first.p(r, c));
  motion::add_outer<kN>(first.p, share * (1.0 - share), d);
}

}  // namespace ttf::fusion::filters
