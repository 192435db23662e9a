// Algorithm A (Bar-Shalom 2002, section III) is exact for one late measurement of the last interval.
//
// Given z(k), the noise v between tau and t(k) has a mean other than zero. With P- = P(k|k-1), and u = H' S^-1
// nu and U = H' S^-1 H of the last update:
//   E v = Q u,  cov(v) = Q - Q U Q,  cov(x(k), v) = Q - P- U Q.
// Exact       one late measurement after each in order. For a second one of the same interval, the first counts as
//             measured at t(k), by its effect on x(k): u <- u + P-^-1 dx, U <- U + P-^-1 (P - P+) P-^-1. Every
//             covariance stays positive, but the result is not exact.
// Stores      x, P; P-, u, U of the last update.
// Costs       a step backwards: an inverse of F and some ten products of n x n; no history.
#pragma once

#include "fusion/oosm/one_lag.h"

namespace ttf::fusion::oosm {

template <int N> class MemoryA {
 public:
  template <int M> [[gnu::flatten]] void corrected(const linear::Matrix<N>& predicted, const Whitened<N, M>& whitened) {
    predicted_ = predicted;
    pull_ = whitened.h.transpose() * whitened.nu;
    information_ = whitened.h.transpose() * whitened.h;
  }
  [[gnu::flatten]] Retrodicted<N> retrodict(const linear::Gaussian<N>& now, const linear::LinearStep<N>& step) const {
    const linear::Matrix<N> uq = information_ * step.q;
    return fusion::oosm::retrodict<N>(now, step.f, step.q * pull_, step.q - step.q * uq, step.q - predicted_ * uq);
  }
  [[gnu::flatten]] void booked(const linear::Gaussian<N>& before, const linear::Gaussian<N>& now) {
    const linear::Matrix<N> root = whitening<N>(predicted_), prior = root.transpose() * root;
    pull_ += prior * (now.x - before.x);
    information_ += prior * (before.p - now.p) * prior;
    linear::symmetrise<N>(information_);
  }

 private:
  linear::Matrix<N> predicted_ = linear::Matrix<N>::Zero();
  linear::Vector<N> pull_ = linear::Vector<N>::Zero();
  linear::Matrix<N> information_ = linear::Matrix<N>::Zero();
};

template <int N, int M, Motion<N> Model> using AlgorithmA = OneLag<N, M, Model, MemoryA<N>, Exactness::kOneLate>;

}  // namespace ttf::fusion::oosm
