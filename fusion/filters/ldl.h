// L D L' decomposition of small symmetric matrices; L is unit lower triangular, D diagonal. Positive definite
// matrices need no pivoting (Higham: "Accuracy and Stability of Numerical Algorithms", 2nd ed., 10.1). The
// loops are unrolled, and only the check of the pivots branches on values. The decompositions read only the
// lower triangle.
#pragma once

#include <cmath>

#include "core/check.h"
#include "fusion/linear/gaussian.h"
#include "fusion/motion/kernels.h"

namespace ttf::fusion::filters {

// Returns whether a covariance from outside is usable (fusion/sensors/sensor_model.h): finite, symmetric to the
// bit, and without pivots that are only rounding, within 1e-12 of the diagonal element.
template <int M> bool positive_definite(const linear::Matrix<M>& a) {
  constexpr double kRounding = 1e-12;
  linear::Matrix<M> l;
  for (int j = 0; j < M; ++j) {
    double d = a(j, j);
    for (int k = 0; k < j; ++k) d -= l(j, k) * l(j, k);
    if (!std::isfinite(a(j, j)) || !(d > kRounding * a(j, j)) || !(a(j, j) > 0.0)) return false;
    l(j, j) = std::sqrt(d);
    for (int i = j + 1; i < M; ++i) {
      if (a(i, j) != a(j, i)) return false;
      double sum = a(i, j);
      for (int k = 0; k < j; ++k) sum -= l(i, k) * l(j, k);
      l(i, j) = sum / l(j, j);
    }
  }
  return true;
}

// Decomposes a positive definite matrix to solve with it. Any other matrix is a mistake of the program;
// positive_definite() tests matrices from outside.
template <int M> class Ldl {
 public:
  explicit Ldl(const linear::Matrix<M>& a) : l_(a) {
    motion::unrolled<M>([&](auto column) {
      constexpr int j = column;
      double d = a(j, j);
      motion::unrolled<j>([&](int k) { d -= l_(j, k) * l_(j, k) * d_[k]; });
      TTF_CHECK(d > 0.0, "a matrix that is not positive definite: pivot {} of {} is {}", j, M, d);
      d_[j] = d;
      inverse_[j] = 1.0 / d;
      motion::unrolled<M - 1 - j>([&](int below) {
        const int i = j + 1 + below;
        double sum = a(i, j);
        motion::unrolled<j>([&](int k) { sum -= l_(i, k) * l_(j, k) * d_[k]; });
        l_(i, j) = sum * inverse_[j];
      });
    });
  }

  // Returns B A^-1 for a B of any number of rows; works on whole columns.
  template <int Rows> linear::Matrix<Rows, M> divide(linear::Matrix<Rows, M> b) const {
    motion::unrolled<M>(
        [&](auto i) { motion::unrolled<i>([&](int k) { b.col(i.value) -= l_(i.value, k) * b.col(k); }); });
    motion::unrolled<M>([&](auto back) {
      constexpr int i = M - 1 - back;
      b.col(i) *= inverse_[i];
      motion::unrolled<back>([&](int above) { b.col(i) -= l_(i + 1 + above, i) * b.col(i + 1 + above); });
    });
    return b;
  }

  // Returns v' A^-1 v.
  double norm_squared(linear::Vector<M> v) const {
    double sum = 0.0;
    motion::unrolled<M>([&](auto row) {
      constexpr int i = row;
      motion::unrolled<i>([&](int k) { v(i) -= l_(i, k) * v(k); });
      sum += v(i) * v(i) * inverse_[i];
    });
    return sum;
  }

  double determinant() const {
    double product = 1.0;
    for (int i = 0; i < M; ++i) product *= d_[i];
    return product;
  }

 private:
  linear::Matrix<M> l_;
  double d_[M], inverse_[M];
};

// Returns a lower triangular A with A A' = P for a positive semi-definite P. A pivot of zero within rounding
// leaves a zero column: that direction has no uncertainty.
template <int N> linear::Matrix<N> square_root(const linear::Matrix<N>& p) {
  constexpr double kRounding = 1e-14;
  linear::Matrix<N> a = linear::Matrix<N>::Zero();
  for (int j = 0; j < N; ++j) {
    double d = p(j, j);
    for (int k = 0; k < j; ++k) d -= a(j, k) * a(j, k);
    if (d <= kRounding * p(j, j)) continue;
    a(j, j) = std::sqrt(d);
    for (int i = j + 1; i < N; ++i) {
      double sum = p(i, j);
      for (int k = 0; k < j; ++k) sum -= a(i, k) * a(j, k);
      a(i, j) = sum / a(j, j);
    }
  }
  return a;
}

}  // namespace ttf::fusion::filters
