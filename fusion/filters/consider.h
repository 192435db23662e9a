// The Schmidt (consider) form: systematic errors b with known covariance B are carried, not estimated. Their
// correlation with the state, C = cov(x, b), is kept, so that the covariance of the state stays true although every
// measurement errs the same way (Schmidt: "Application of state space methods to navigation problems", Advances in
// Control Systems 3, 1966).
//
// z = h(x) + D b + v:
//   W = H P + D C',  S = W H' + (H C + D B) D' + R,  K = W' S^-1,
//   x <- x + K nu,  C <- C - K (H C + D B),  T = P - K W,  P <- T - (T H' + C_after D' - K R) K',
// the last in Joseph form (correct.h).
// Prediction: C <- F C, B stays.
#pragma once

#include "fusion/filters/correct.h"
#include "fusion/filters/extended.h"
#include "fusion/motion/kernels.h"

namespace ttf::fusion::filters {

// N states and B biases of all sensors together, each sensor's one after the other.
template <int N, int B>
struct Considered {
  Gaussian<N> state;
  Matrix<N, B> cross = Matrix<N, B>::Zero();
  Matrix<B> bias = Matrix<B>::Zero();   // covariance of what is left after known biases are corrected for
};

struct Consider {
  static constexpr const char* kName = "Consider";

  template <motion::Model M, int B>
  void predict(const M& model, Considered<M::kStates, B>& considered, double dt) const {
    considered.cross = times<M::kStates, M::kStates, B>(model.jacobian(considered.state.x, dt), considered.cross);
    Extended{}.predict(model, considered.state, dt);
  }

  // The sensor's biases are those from index First on.
  template <int First = 0, motion::Model M, sensors::Biased S, int B>
    requires(First + S::kBiases <= B)
  Innovation<S::kDimension> update(const M&, const S& sensor, const sensors::Measurement<S::kDimension>& z,
                                   Considered<M::kStates, B>& c) const {
    constexpr int kN = M::kStates, kM = S::kDimension, kC = leading_columns(S::kParts);
    const Kinematics k = M::template kinematics<S::kParts>(c.state.x);
    if (!sensor.sees(k)) return {};
    const Matrix<kM, kC> h = measurement_matrix<M>(sensor, k, c.state.x);
    const Matrix<kM, S::kBiases> d = sensor.bias_jacobian(k);

    constexpr int kS = S::kBiases;   // this sensor's
    const Matrix<kC, kN> leading = c.state.p.template topRows<kC>();
    const Matrix<kC, B> leading_cross = c.cross.template topRows<kC>();
    const Matrix<kN, kS> own_cross = c.cross.template middleCols<kS>(First);
    const Matrix<kS, B> own_bias = c.bias.template middleRows<kS>(First);
    Matrix<kM, kN> w = times<kM, kC, kN>(h, leading);                  // cov(z, x)
    add_scaled<kM, kN>(w, 1.0, times_transposed<kM, kS, kN>(d, own_cross));
    Matrix<kM, B> with_bias = times<kM, kC, B>(h, leading_cross);      // cov(z, b)
    add_scaled<kM, B>(with_bias, 1.0, times<kM, kS, B>(d, own_bias));
    Innovation<kM> innovation;
    innovation.nu = sensor.residual(z.z, sensor.expected(k));
    innovation.s = times_transposed<kM, kC, kM>(w.template leftCols<kC>(), h) + z.r;
    add_scaled<kM, kM>(innovation.s, 1.0, times_transposed<kM, kS, kM>(with_bias.template middleCols<kS>(First), d));
    symmetrise<kM>(innovation.s);
    const Ldl<kM> ldl(innovation.s);
    innovation.nis = ldl.norm_squared(innovation.nu);
    innovation.determinant = ldl.determinant();
    innovation.used = true;

    const Matrix<kN, kM> gain = ldl.template divide<kN>(w.transpose());
    c.state.x += gain * innovation.nu;
    M::normalise(c.state.x);
    add_scaled<kN, B>(c.cross, -1.0, times<kN, kM, B>(gain, with_bias));
    Matrix<kN> t = c.state.p;
    add_scaled<kN, kN>(t, -1.0, times<kN, kM, kN>(gain, w));
    Matrix<kN, kM> e = times_transposed<kN, kC, kM>(t.template leftCols<kC>(), h);
    add_scaled<kN, kM>(e, 1.0, times_transposed<kN, kS, kM>(c.cross.template middleCols<kS>(First), d));
    add_scaled<kN, kM>(e, -1.0, times<kN, kM, kM>(gain, z.r));
    add_scaled<kN, kN>(t, -1.0, times_transposed<kN, kM, kN>(e, gain));
    c.state.p = t;
    symmetrise<kN>(c.state.p);
    return innovation;
  }
};

}  // namespace ttf::fusion::filters
