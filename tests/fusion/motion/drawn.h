// Shared by the tests of models and filters: drawn states, derivatives by central differences.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.h"
#include "fusion/filters/ldl.h"
#include "fusion/motion/constant_acceleration.h"
#include "fusion/motion/constant_velocity.h"
#include "fusion/motion/ctra.h"
#include "fusion/motion/ctrv.h"
#include "fusion/motion/kernels.h"

namespace ttf::fusion::motion {

using AllMotions = testing::Types<motion::ConstantVelocity, motion::ConstantAcceleration, motion::Ctrv, motion::Ctra>;

// Draws a vehicle within 100 m: up to 20 m/s, 1 rad/s, 3 m/s^2. Every third draw has a turn rate where
// formulas switch or cancel.
template <class M> linear::Vector<M::kStates> drawn_state(RandomStream& stream, int draw) {
  linear::Vector<M::kStates> x;
  x(0) = stream.uniform(-100.0, 100.0);
  x(1) = stream.uniform(-100.0, 100.0);
  if constexpr (M::kCartesian) {
    for (int i = 2; i < M::kStates; ++i) x(i) = stream.uniform(-10.0, 10.0);
  } else {
    constexpr double kCritical[] = {0.0, 1e-12, -1e-8, 1e-5, -1e-3, 1.0, -1.0 - 1e-9, 2.0 - 1e-9};
    x(2) = stream.uniform(-3.1, 3.1);
    x(3) = stream.uniform(-5.0, 20.0);
    x(4) = draw % 3 == 0 ? kCritical[(draw / 3) % 8] : stream.uniform(-1.0, 1.0);
    if constexpr (M::kStates == 6) x(5) = stream.uniform(-3.0, 3.0);
  }
  return x;
}

// Positive definite, of the size of `sigma`.
template <int N> linear::Matrix<N> drawn_covariance(RandomStream& stream, double sigma) {
  linear::Matrix<N> a;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) a(i, j) = sigma * stream.normal();
  linear::Matrix<N> p = sandwich<N, N>(a, linear::Matrix<N>::Identity());
  for (int i = 0; i < N; ++i) p(i, i) += 0.1 * sigma * sigma;
  return p;
}

// From N(mean, covariance).
template <int N>
linear::Vector<N> drawn(const linear::Vector<N>& mean, const linear::Matrix<N>& covariance, RandomStream& stream) {
  linear::Vector<N> white;
  for (int i = 0; i < N; ++i) white(i) = stream.normal();
  return mean + times<N, N, 1>(filters::square_root<N>(covariance), white);
}

// d f / d x by central differences with the step 1e-5 max(1, |x_i|). Errors are about 1e-10 |f'''| + 1e-11
// |f|.
template <int Rows, int N, class Function, class Difference>
linear::Matrix<Rows, N> numerical_jacobian(const Function& f, const linear::Vector<N>& x,
                                           const Difference& difference) {
  linear::Matrix<Rows, N> j;
  for (int i = 0; i < N; ++i) {
    const double step = 1e-5 * std::max(1.0, std::abs(x(i)));
    linear::Vector<N> above = x, below = x;
    above(i) += step;
    below(i) -= step;
    const linear::Vector<Rows> column = difference(f(above), f(below));
    j.col(i) = column / (above(i) - below(i));
  }
  return j;
}

// Largest difference, relative to the larger of 1 and the largest of b.
template <int R, int C> double apart(const linear::Matrix<R, C>& a, const linear::Matrix<R, C>& b) {
  double difference = 0.0, size = 1.0;
  for (int i = 0; i < R; ++i)
    for (int j = 0; j < C; ++j) {
      if (!std::isfinite(a(i, j))) return std::numeric_limits<double>::infinity();
      difference = std::max(difference, std::abs(a(i, j) - b(i, j)));
      size = std::max(size, std::abs(b(i, j)));
    }
  return difference / size;
}

// To the last bit.
template <int R, int C> bool same(const linear::Matrix<R, C>& a, const linear::Matrix<R, C>& b) {
  for (int i = 0; i < R; ++i)
    for (int j = 0; j < C; ++j)
      if (a(i, j) != b(i, j)) return false;
  return true;
}
template <int N> bool symmetric(const linear::Matrix<N>& a) {
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < i; ++j)
      if (a(i, j) != a(j, i)) return false;
  return true;
}

}  // namespace ttf::fusion::motion
