// Products of small matrices as plain loops, for templates with many shapes. They compile in a tenth of the
// time of expression templates. The loops fix the order of summation.
#pragma once

#include <type_traits>
#include <utility>

#include "fusion/linear/gaussian.h"

namespace ttf::fusion::motion {

// Calls body(0), ..., body(N - 1) with constant indices: g++ at -O2 does not unroll most small loops.
template <int N, class Body> constexpr void unrolled(const Body& body) {
  [&]<int... I>(std::integer_sequence<int, I...>) { (body(std::integral_constant<int, I>{}), ...); }
  (std::make_integer_sequence<int, N>{});
}

// Copies the lower triangle to the upper one; the matrix is symmetric up to rounding.
template <int N> void mirror(linear::Matrix<N>& p) {
  unrolled<N>([&](auto c) { unrolled<c>([&](int r) { p(c.value, r) = p(r, c.value); }); });
}

// Returns A B.
template <int R, int K, int C>
linear::Matrix<R, C> times(const linear::Matrix<R, K>& a, const linear::Matrix<K, C>& b) {
  linear::Matrix<R, C> out;
  for (int j = 0; j < C; ++j)
    for (int i = 0; i < R; ++i) {
      double sum = 0.0;
      for (int k = 0; k < K; ++k) sum += a(i, k) * b(k, j);
      out(i, j) = sum;
    }
  return out;
}

// Returns A B'.
template <int R, int K, int C>
linear::Matrix<R, C> times_transposed(const linear::Matrix<R, K>& a, const linear::Matrix<C, K>& b) {
  linear::Matrix<R, C> out;
  for (int j = 0; j < C; ++j)
    for (int i = 0; i < R; ++i) {
      double sum = 0.0;
      for (int k = 0; k < K; ++k) sum += a(i, k) * b(j, k);
      out(i, j) = sum;
    }
  return out;
}

// Returns J P J'. Only the innermost loops are unrolled: that brings most of the speed at little compile time.
template <int N, int K> linear::Matrix<N> sandwich(const linear::Matrix<N, K>& j, const linear::Matrix<K>& p) {
  linear::Matrix<N, K> jp;
  for (int c = 0; c < K; ++c)
    for (int r = 0; r < N; ++r) {
      double sum = 0.0;
      unrolled<K>([&](int k) { sum += j(r, k) * p(k, c); });
      jp(r, c) = sum;
    }
  linear::Matrix<N> out;
  for (int c = 0; c < N; ++c)
    for (int r = 0; r <= c; ++r) {
      double sum = 0.0;
      unrolled<K>([&](int k) { sum += jp(r, k) * j(c, k); });
      out(r, c) = out(c, r) = sum;
    }
  return out;
}

// Adds weight v v' to P.
template <int N> void add_outer(linear::Matrix<N>& p, double weight, const linear::Vector<N>& v) {
  for (int c = 0; c < N; ++c) unrolled<N>([&](int r) { p(r, c) += weight * (v(r) * v(c)); });
}

// Adds weight b to a, in any shape.
template <int N, int K> void add_scaled(linear::Matrix<N, K>& a, double weight, const linear::Matrix<N, K>& b) {
  for (int c = 0; c < K; ++c)
    for (int r = 0; r < N; ++r) a(r, c) += weight * b(r, c);
}

}  // namespace ttf::fusion::motion
