// Algorithm B (Bar-Shalom 2002, section IV) is Algorithm A without the last innovation. It assumes that the
// noise v between tau and t(k) has mean zero. With P- = P(k|k-1), and U = H' S^-1 H of the last update:
//   cov(v) = Q,  cov(x(k), v) = Q - P- U Q.
//
// Exact       without process noise only. "Practically indistinguishable" from A in the paper's examples.
//             A second late measurement of the same interval: as in algorithm_a.h.
// Stores      x, P; P-, U of the last update.
// Costs       as Algorithm A.
#pragma once

#include "fusion/oosm/one_lag.h"

namespace ttf::fusion::oosm {

template <int N> class MemoryB {
 public:
  template <int M> [[gnu::flatten]] void corrected(const linear::Matrix<N>& predicted, const Whitened<N, M>& whitened) {
    predicted_ = predicted;
    information_ = whitened.h.transpose() * whitened.h;
  }
  [[gnu::flatten]] Retrodicted<N> retrodict(const linear::Gaussian<N>& now, const linear::LinearStep<N>& step) const {
    const linear::Matrix<N> cross = step.q - predicted_ * information_ * step.q;
    return fusion::oosm::retrodict<N>(now, step.f, linear::Vector<N>::Zero(), step.q, cross);
  }
  [[gnu::flatten]] void booked(const linear::Gaussian<N>& before, const linear::Gaussian<N>& now) {
    const linear::Matrix<N> root = whitening<N>(predicted_), prior = root.transpose() * root;
    information_ += prior * (before.p - now.p) * prior;
    linear::symmetrise<N>(information_);
  }

 private:
  linear::Matrix<N> predicted_ = linear::Matrix<N>::Zero();
  linear::Matrix<N> information_ = linear::Matrix<N>::Zero();
};

template <int N, int M, Motion<N> Model> using AlgorithmB = OneLag<N, M, Model, MemoryB<N>, Exactness::kApproximate>;

}  // namespace ttf::fusion::oosm
