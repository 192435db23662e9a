// The update as the textbook has it, the oracle of those that are fast (filters/correct.h, oosm/correction.h):
//   nu = z - H x,  S = H P H' + R,  K = P H' S^-1 by an LDLT solve,  x <- x + K nu,
//   P <- (I - K H) P (I - K H)' + K R K'  (Bar-Shalom, Li, Kirubarajan 2001, 5.2.3-18).
#pragma once

#include "fusion/gaussian.h"
#include "tests/fusion/dense.h"

namespace ttf::fusion {

// What an update did; nu and S are those before it.
template <int N, int M>
struct Correction {
  Vector<M> nu;
  Matrix<M> s;
  Matrix<N, M> k;
};

template <int N, int M>
Correction<N, M> update(Gaussian<N>& state, const LinearMeasurement<N, M>& measurement) {
  const dense::Correction c = dense::update(state.x, state.p, measurement.z, measurement.h, measurement.r);
  state.x = c.x;
  state.p = c.p;
  return {c.nu, c.s, c.k};
}

}  // namespace ttf::fusion
