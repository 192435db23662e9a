// The vocabulary of the filters: fixed-size vectors and matrices, the normal distribution, one linear step and one
// linear measurement of it.
//
// Prediction over a step  x' = F x + w, w ~ N(0, Q):   x <- F x,  P <- F P F' + Q.
// Update with  z = H x + v, v ~ N(0, R):   nu = z - H x,  S = H P H' + R,  K = P H' S^-1 by an LDLT solve,
// x <- x + K nu, P in Joseph form  (I - K H) P (I - K H)' + K R K'  (Bar-Shalom, Li, Kirubarajan: "Estimation with
// Applications to Tracking and Navigation", 2001, 5.2.3-18), so that P stays symmetric and positive.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace ttf::fusion {

template <int Rows>
using Vector = Eigen::Matrix<double, Rows, 1>;
template <int Rows, int Columns = Rows>
using Matrix = Eigen::Matrix<double, Rows, Columns>;

// Mean and covariance, symmetric positive semi-definite.
template <int N>
struct Gaussian {
  Vector<N> x = Vector<N>::Zero();
  Matrix<N> p = Matrix<N>::Zero();
};

template <int N>
struct LinearStep {
  Matrix<N> f = Matrix<N>::Identity();
  Matrix<N> q = Matrix<N>::Zero();   // symmetric positive semi-definite
};

// r is symmetric positive definite.
template <int N, int M>
struct LinearMeasurement {
  Vector<M> z = Vector<M>::Zero();
  Matrix<M, N> h = Matrix<M, N>::Zero();
  Matrix<M> r = Matrix<M>::Identity();
};

// What an update did; nu and S are those before it.
template <int N, int M>
struct Correction {
  Vector<M> nu;
  Matrix<M> s;
  Matrix<N, M> k;
};

template <int N>
void symmetrise(Matrix<N>& p) {
  p = (0.5 * (p + p.transpose())).eval();
}

template <int N>
void predict(Gaussian<N>& state, const LinearStep<N>& step) {
  state.x = (step.f * state.x).eval();
  state.p = (step.f * state.p * step.f.transpose() + step.q).eval();
  symmetrise<N>(state.p);
}

template <int N, int M>
Correction<N, M> update(Gaussian<N>& state, const LinearMeasurement<N, M>& measurement) {
  Correction<N, M> c;
  c.nu = measurement.z - measurement.h * state.x;
  const Matrix<M, N> hp = measurement.h * state.p;
  c.s = hp * measurement.h.transpose() + measurement.r;
  symmetrise<M>(c.s);
  c.k = c.s.ldlt().solve(hp).transpose();
  state.x += c.k * c.nu;
  const Matrix<N> a = Matrix<N>::Identity() - c.k * measurement.h;
  state.p = (a * state.p * a.transpose() + c.k * measurement.r * c.k.transpose()).eval();
  symmetrise<N>(state.p);
  return c;
}

}  // namespace ttf::fusion
