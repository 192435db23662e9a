// The update that the Kalman, the extended and the Schmidt filter share. H = [H_c 0] with C leading columns:
//   W = H P,  S = W H' + R,  K = W' S^-1,  x <- x + K nu,
// The covariance is in Joseph form, (I - K H) P (I - K H)' + K R K' (Bar-Shalom, Li, Kirubarajan 2001,
// 5.2.3-18), multiplied out so that I - K H is never formed:
//   T = P - K W,   P <- T - (T H' - K R) K'.
// T H' - K R is zero except for the rounding of K. The second term removes the first-order effect of K's error
// from P, which is the purpose of the Joseph form. The cost is O(n^2 m); zero columns of H cost nothing. With Direct,
// H_c is the identity.
#pragma once

#include "fusion/filters/filter.h"
#include "fusion/motion/kernels.h"

namespace ttf::fusion::filters {

// Computes W' and S; the code works on whole columns.
template <bool Direct, int N, int M, int C>
void project(const linear::Matrix<N>& p, const linear::Matrix<M, C>& h, const linear::Matrix<M>& r,
             linear::Matrix<N, M>& w, linear::Matrix<M>& s) {
  if constexpr (Direct) {
    w = p.template leftCols<M>();
    s = w.template topRows<M>() + r;
  } else {
    w.noalias() = p.template leftCols<C>() * h.transpose();
    s = motion::times<M, C, M>(h, w.template topRows<C>()) + r;
    motion::mirror<M>(s);
  }
}

// Completes an innovation from its nu and S.
template <int M> void judge(Innovation<M>& innovation, const Ldl<M>& ldl) {
  innovation.nis = ldl.norm_squared(innovation.nu);
  innovation.determinant = ldl.determinant();
  innovation.used = true;
}

// Returns the innovation that correct() would find, and changes nothing.
template <bool Direct, int N, int M, int C>
Innovation<M> innovate(const linear::Gaussian<N>& state, const linear::Vector<M>& nu, const linear::Matrix<M, C>& h,
                       const linear::Matrix<M>& r) {
  linear::Matrix<N, M> w;
  Innovation<M> innovation;
  innovation.nu = nu;
  project<Direct>(state.p, h, r, w, innovation.s);
  judge<M>(innovation, Ldl<M>(innovation.s));
  return innovation;
}

template <bool Direct, int N, int M, int C>
Innovation<M> correct(linear::Gaussian<N>& state, const linear::Vector<M>& nu, const linear::Matrix<M, C>& h,
                      const linear::Matrix<M>& r) {
  linear::Matrix<N, M> w;
  Innovation<M> innovation;
  innovation.nu = nu;
  project<Direct>(state.p, h, r, w, innovation.s);
  const Ldl<M> ldl(innovation.s);
  judge<M>(innovation, ldl);
  const linear::Matrix<N, M> gain = ldl.template divide<N>(w);
  state.x.noalias() += gain.lazyProduct(nu);
  linear::Matrix<N> t;
  t.noalias() = state.p - gain.lazyProduct(w.transpose());
  linear::Matrix<N, M> e;
  if constexpr (Direct)
    e = t.template leftCols<M>();
  else
    e.noalias() = t.template leftCols<C>() * h.transpose();
  e.noalias() -= gain.lazyProduct(r);
  state.p.noalias() = t - e.lazyProduct(gain.transpose());
  motion::mirror<N>(state.p);
  return innovation;
}

}  // namespace ttf::fusion::filters
