// L D L' of small symmetric matrices: L unit lower triangular, D diagonal. Without pivoting, which positive definite
// matrices do not need (Higham: "Accuracy and Stability of Numerical Algorithms", 2nd ed., 10.1): unrolled, nothing
// branches on the numbers but the check that they are one. Only the lower triangle is read.
#pragma once

#include <cmath>

#include "core/check.h"
#include "fusion/linear/gaussian.h"
#include "fusion/motion/kernels.h"

namespace ttf::fusion::filters {

// What whoever takes in a covariance from outside asks of it (fusion/sensors/sensor_model.h): finite, symmetric to the
// bit, and no pivot that is rounding only, within 1e-12 of its diagonal element.
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

// Of a positive definite matrix, for solving; anything else is a mistake of the program (positive_definite() above is
// for asking).
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

  // B A^-1, for B with columns of any length: whole columns at a time.
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

  // v' A^-1 v.
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

// A lower triangular with A A' = P for a positive semi-definite P: a pivot that is zero within rounding leaves a zero
// column, for there is no uncertainty in that direction.
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
