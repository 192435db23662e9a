// Returns the inverse of the Cholesky factor, L^-1 of S = L L'. It turns a vector of covariance S into
// independent components of variance 1. The code for one or two dimensions, the usual measurements, is written
// out.
//
// S is symmetric and positive semi-definite. A direction that is only rounding (a pivot below 1e-14 of its
// diagonal element) carries no information: its row of L^-1 is zero. So  (L^-1)' L^-1  is S^-1 if S is regular.
#pragma once

#include <cmath>

#include "fusion/linear/gaussian.h"

namespace ttf::fusion::oosm {

inline constexpr double kNoPivot = 1e-14;

// Returns 1 / sqrt(pivot), or zero for a pivot that is only rounding.
inline double inverse_root(double pivot, double diagonal) {
  return pivot > kNoPivot * diagonal ? 1.0 / std::sqrt(pivot) : 0.0;
}

template <int M> linear::Matrix<M> whitening(const linear::Matrix<M>& s) {
  linear::Matrix<M> inverse = linear::Matrix<M>::Zero();
  inverse(0, 0) = inverse_root(s(0, 0), s(0, 0));
  if constexpr (M == 2) {
    const double below = s(1, 0) * inverse(0, 0);
    inverse(1, 1) = inverse_root(s(1, 1) - below * below, s(1, 1));
    inverse(1, 0) = -inverse(1, 1) * below * inverse(0, 0);
  } else if constexpr (M > 2) {
    linear::Matrix<M> root = linear::Matrix<M>::Zero();
    for (int j = 0; j < M; ++j) {
      double pivot = s(j, j);
      for (int k = 0; k < j; ++k) pivot -= root(j, k) * root(j, k);
      inverse(j, j) = inverse_root(pivot, s(j, j));
      for (int i = j + 1; i < M; ++i) {
        double element = s(i, j);
        for (int k = 0; k < j; ++k) element -= root(i, k) * root(j, k);
        root(i, j) = element * inverse(j, j);
      }
      for (int i = 0; i < j; ++i) {
        double sum = 0.0;
        for (int k = i; k < j; ++k) sum += root(j, k) * inverse(k, i);
        inverse(j, i) = -inverse(j, j) * sum;
      }
    }
  }
  return inverse;
}

}  // namespace ttf::fusion::oosm
