// Types of the filters: fixed-size vectors and matrices, the normal distribution, one linear transition and one
// linear measurement.
//
// Prediction by  x' = F x + w, w ~ N(0, Q):   x <- F x,  P <- F P F' + Q.
// Update with  z = H x + v, v ~ N(0, R):      filters/correct.h, and for late measurements oosm/correction.h.
#pragma once

#include <Eigen/Core>

namespace ttf::fusion::linear {

template <int Rows> using Vector = Eigen::Matrix<double, Rows, 1>;
template <int Rows, int Columns = Rows> using Matrix = Eigen::Matrix<double, Rows, Columns>;

// A mean and a covariance; the covariance is symmetric positive semi-definite.
template <int N> struct Gaussian {
  Vector<N> x = Vector<N>::Zero();
  Matrix<N> p = Matrix<N>::Zero();
};

template <int N> struct LinearStep {
  Matrix<N> f = Matrix<N>::Identity();
  Matrix<N> q = Matrix<N>::Zero();  // symmetric positive semi-definite
};

// A linear measurement; r is symmetric positive definite.
template <int N, int M> struct LinearMeasurement {
  Vector<M> z = Vector<M>::Zero();
  Matrix<M, N> h = Matrix<M, N>::Zero();
  Matrix<M> r = Matrix<M>::Identity();
};

template <int N> void symmetrise(Matrix<N>& p) { p = (0.5 * (p + p.transpose())).eval(); }

template <int N> void predict(Gaussian<N>& state, const LinearStep<N>& step) {
  state.x = (step.f * state.x).eval();
  state.p = (step.f * state.p * step.f.transpose() + step.q).eval();
  symmetrise<N>(state.p);
}

}  // namespace ttf::fusion::linear
