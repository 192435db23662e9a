// The update in order that all methods here share, and its parts for later use. With S = H P H' + R = L L'
// (Cholesky):
//   h = L^-1 H,  nu = L^-1 (z - H x),  V = P h',  K = V L^-1;   x <- x + V nu,  T = P - V V',
//   P <- T - (T H' - K R) K',   the Joseph form multiplied out: O(n^2 m), and I - K H is never formed.
// It equals the update of fusion/filters/correct.h up to rounding, for any P and H. Retrodiction needs only h,
// nu and V of it:  H' S^-1 H = h' h,  H' S^-1 nu = h' nu,  K H = V h.
//
// [[gnu::flatten]] marks the small arithmetic functions of this folder. At -O2 the compiler leaves most of
// Eigen's small products as calls, which cost more than the products.
#pragma once

#include "fusion/linear/gaussian.h"
#include "fusion/oosm/whitening.h"

namespace ttf::fusion::oosm {

template <int N, int M> struct Whitened {
  linear::Matrix<M, N> h;
  linear::Vector<M> nu;
  linear::Matrix<N, M> v;
};

template <int N, int M>
[[gnu::flatten]] Whitened<N, M> correct(linear::Gaussian<N>& state,
                                        const linear::LinearMeasurement<N, M>& measurement) {
  const linear::Matrix<M, N> hp = measurement.h * state.p;
  linear::Matrix<M> s = measurement.r;
  s.noalias() += hp * measurement.h.transpose();
  const linear::Matrix<M> root = whitening<M>(s);
  Whitened<N, M> result;
  result.h.noalias() = root * measurement.h;
  result.nu.noalias() = root * (measurement.z - measurement.h * state.x);
  result.v.noalias() = hp.transpose() * root.transpose();
  state.x.noalias() += result.v * result.nu;
  const linear::Matrix<N, M> gain = result.v * root;
  linear::Matrix<N> p = state.p;
  p.noalias() -= result.v * result.v.transpose();
  linear::Matrix<N, M> slip;  // T H' - K R
  slip.noalias() = p * measurement.h.transpose();
  slip.noalias() -= gain * measurement.r;
  p.noalias() -= slip * gain.transpose();
  state.p.noalias() = 0.5 * (p + p.transpose());
  return result;
}

}  // namespace ttf::fusion::oosm
