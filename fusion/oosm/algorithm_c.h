// Algorithm C (Bar-Shalom 2002, section V) ignores the noise between tau and t(k): x(tau) = F^-1 x(k).
//
// Exact       without process noise only. With noise the covariance is too small, and with strong noise the estimate is
//             worse than without the late measurement. It serves as a yardstick, not as a choice.
// Stores      only x, P.
// Costs       a step backwards: an inverse of F and four products of n x n.
#pragma once

#include "fusion/oosm/one_lag.h"

namespace ttf::fusion::oosm {

template <int N> class MemoryC {
 public:
  template <int M> void corrected(const linear::Matrix<N>&, const Whitened<N, M>&) {}
  Retrodicted<N> retrodict(const linear::Gaussian<N>& now, const linear::LinearStep<N>& step) const {
    return fusion::oosm::retrodict<N>(now, step.f, linear::Vector<N>::Zero(), linear::Matrix<N>::Zero(),
                                      linear::Matrix<N>::Zero());
  }
  void booked(const linear::Gaussian<N>&, const linear::Gaussian<N>&) {}
};

template <int N, int M, Motion<N> Model> using AlgorithmC = OneLag<N, M, Model, MemoryC<N>, Exactness::kApproximate>;

}  // namespace ttf::fusion::oosm
