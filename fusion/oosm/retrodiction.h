// The estimate of an earlier instant tau at the newest instant k, and the update by a measurement of tau.
//
// With  xt, Pt  mean and covariance of x(tau) and  C = cov(x(k), x(tau)), all given the measurements taken so
// far:
//   nu = z - H xt,  S = H Pt H' + R,  W = C H' S^-1,  x <- x + W nu,  P <- P - W S W'.
// With S = L L' (Cholesky) and V = C H' L'^-1 this is  x <- x + V L^-1 nu,  P <- P - V V', symmetric to the
// bit.
#pragma once

#include <Eigen/LU>

#include "fusion/linear/gaussian.h"
#include "fusion/oosm/whitening.h"

namespace ttf::fusion::oosm {

template <int N> struct Retrodicted {
  linear::Gaussian<N> then;  // x(tau)
  linear::Matrix<N> cross;   // cov(x(k), x(tau))
};

template <int N, int M>
[[gnu::flatten]] void fuse_retrodicted(linear::Gaussian<N>& now, const Retrodicted<N>& retrodicted,
                                       const linear::LinearMeasurement<N, M>& measurement) {
  const linear::Matrix<M> s = measurement.h * retrodicted.then.p * measurement.h.transpose() + measurement.r;
  const linear::Matrix<M> root = whitening<M>(s);
  const linear::Matrix<N, M> v = retrodicted.cross * (root * measurement.h).transpose();
  const linear::Vector<M> nu = root * (measurement.z - measurement.h * retrodicted.then.x);
  now.x += v * nu;
  now.p -= v * v.transpose();
}

// Displaces both instants of a retrodiction together.
template <int N>
void displace(linear::Gaussian<N>& now, Retrodicted<N>& retrodicted, const Displacement<N>& displacement) {
  displacement.move(now);
  displacement.move(retrodicted.then);
  retrodicted.cross += displacement.spread;
}

// Retrodicts over x(k) = F x(tau) + v, given the mean of v, its covariance and cov(x(k), v). F is a transition
// matrix over a short step and well conditioned.
template <int N>
[[gnu::flatten]] Retrodicted<N> retrodict(const linear::Gaussian<N>& now, const linear::Matrix<N>& f,
                                          const linear::Vector<N>& noise, const linear::Matrix<N>& noise_p,
                                          const linear::Matrix<N>& cross) {
  const linear::Matrix<N> back = f.inverse();
  Retrodicted<N> result;
  result.then.x = back * (now.x - noise);
  const linear::Matrix<N> difference = now.p - cross;
  result.cross = difference * back.transpose();
  linear::Matrix<N> p = difference + noise_p - cross.transpose();
  linear::symmetrise<N>(p);
  result.then.p = back * p * back.transpose();
  return result;
}

}  // namespace ttf::fusion::oosm
