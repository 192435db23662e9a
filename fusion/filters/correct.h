// The update that the Kalman, the extended and the Schmidt filter share, with H = [H_c 0] of C leading columns:
//   W = H P,  S = W H' + R,  K = W' S^-1,  x <- x + K nu,
// and the covariance in Joseph form, (I - K H) P (I - K H)' + K R K' (Bar-Shalom, Li, Kirubarajan 2001, 5.2.3-18),
// multiplied out so that I - K H is never formed:
//   T = P - K W,   P <- T - (T H' - K R) K'.
// T H' - K R is zero but for rounding of K: the second term takes the first order of what K is wrong by out of P, which
// is what the Joseph form is for. O(n^2 m), and zero columns of H cost nothing. Direct: H_c is the identity.
#pragma once

#include "fusion/filters/filter.h"
#include "fusion/motion/kernels.h"

namespace ttf::fusion::filters {

template <bool Direct, int N, int M, int C>
Innovation<M> correct(Gaussian<N>& state, const Vector<M>& nu, const Matrix<M, C>& h, const Matrix<M>& r) {
  Matrix<N, M> w;   // W': whole columns, as everything here
  Innovation<M> innovation;
  innovation.nu = nu;
  if constexpr (Direct) {
    w = state.p.template leftCols<M>();
    innovation.s = w.template topRows<M>() + r;
  } else {
    w.noalias() = state.p.template leftCols<C>() * h.transpose();
    innovation.s = times<M, C, M>(h, w.template topRows<C>()) + r;
    mirror<M>(innovation.s);
  }
  const Ldl<M> ldl(innovation.s);
  innovation.nis = ldl.norm_squared(nu);
  innovation.determinant = ldl.determinant();
  innovation.used = true;
  const Matrix<N, M> gain = ldl.template divide<N>(w);
  state.x.noalias() += gain.lazyProduct(nu);
  Matrix<N> t;
  t.noalias() = state.p - gain.lazyProduct(w.transpose());
  Matrix<N, M> e;
  if constexpr (Direct)
    e = t.template leftCols<M>();
  else
    e.noalias() = t.template leftCols<C>() * h.transpose();
  e.noalias() -= gain.lazyProduct(r);
  state.p.noalias() = t - e.lazyProduct(gain.transpose());
  mirror<N>(state.p);
  return innovation;
}

}  // namespace ttf::fusion::filters
