// The textbook's update, the oracle of the fast ones (filters/correct.h, oosm/correction.h):
//   nu = z - H x,  S = H P H' + R,  K = P H' S^-1 by an LDLT solve,  x <- x + K nu,
//   P <- (I - K H) P (I - K H)' + K R K'  (Bar-Shalom, Li, Kirubarajan 2001, 5.2.3-18).
#pragma once

#include <Eigen/Cholesky>

#include "fusion/linear/gaussian.h"

namespace ttf::fusion {

// An update's gain and innovation; nu and S are those before it.
template <int N, int M> struct Correction {
  linear::Vector<M> nu;
  linear::Matrix<M> s;
  linear::Matrix<N, M> k;
};

template <int N, int M>
Correction<N, M> update(linear::Gaussian<N>& state, const linear::LinearMeasurement<N, M>& measurement) {
  Correction<N, M> c;
  c.nu = measurement.z - measurement.h * state.x;
  const linear::Matrix<M, N> hp = measurement.h * state.p;
  c.s = hp * measurement.h.transpose() + measurement.r;
  linear::symmetrise<M>(c.s);
  c.k = c.s.ldlt().solve(hp).transpose();
  state.x += c.k * c.nu;
  const linear::Matrix<N> a = linear::Matrix<N>::Identity() - c.k * measurement.h;
  state.p = (a * state.p * a.transpose() + c.k * measurement.r * c.k.transpose()).eval();
  linear::symmetrise<N>(state.p);
  return c;
}

}  // namespace ttf::fusion
