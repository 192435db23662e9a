// The Schmidt (consider) filter carries systematic errors b of known covariance B without estimating them. It
// keeps their correlation with the state, C = cov(x, b). So the state's covariance stays true although all
// measurements share the same error (Schmidt: "Application of state space methods to navigation problems",
// Advances in Control Systems 3, 1966).
//
// Update with z = h(x) + D b + v:
//   W = H P + D C',  S = W H' + (H C + D B) D' + R,  K = W' S^-1,
//   x <- x + K nu,  C <- C - K (H C + D B),  T = P - K W,  P <- T - (T H' + C_after D' - K R) K',
// the last in Joseph form (correct.h).
// Prediction: C <- F C, B stays.
#pragma once

#include "fusion/filters/considered.h"
#include "fusion/filters/correct.h"
#include "fusion/filters/extended.h"
#include "fusion/motion/kernels.h"

namespace ttf::fusion::filters {

template <int B> struct Consider {
  static constexpr const char* kName = "Consider";
  static constexpr int kBiases = B;

  linear::Matrix<B> bias =
      linear::Matrix<B>::Zero();  // covariance of the errors that remain after correction for known biases

  template <motion::Model M> void predict(const M& model, Considered<M::kStates, B>& considered, double dt) const {
    considered.cross =
        motion::times<M::kStates, M::kStates, B>(model.jacobian(considered.state.x, dt), considered.cross);
    Extended{}.predict(model, considered.state, dt);
  }

  // Returns the innovation without an update. Here and in update() the sensor's biases begin at index First.
  template <int First = 0, motion::Model M, sensors::Biased S>
  requires(First + S::kBiases <= B) Innovation<S::kDimension> innovate(const M&, const S& sensor,
                                                                       const sensors::Measurement<S::kDimension>& z,
                                                                       const Considered<M::kStates, B>& c)
  const {
    Sight<M, S> sight;
    if (!look<First>(sensor, z, c, sight)) return {};
    judge<S::kDimension>(sight.innovation, Ldl<S::kDimension>(sight.innovation.s));
    return sight.innovation;
  }

  // Returns the covariance of the expected measurement, with noise z.r; z.z is not used.
  template <int First = 0, motion::Model M, sensors::Biased S>
  requires(First + S::kBiases <= B) linear::Matrix<S::kDimension> spread(const M&, const S& sensor,
                                                                         const sensors::Measurement<S::kDimension>& z,
                                                                         const Considered<M::kStates, B>& c)
  const {
    Sight<M, S> sight;
    look<First>(sensor, z, c, sight);
    return sight.innovation.s;
  }

  template <int First = 0, motion::Model M, sensors::Biased S>
  requires(First + S::kBiases <= B) Innovation<S::kDimension> update(const M&, const S& sensor,
                                                                     const sensors::Measurement<S::kDimension>& z,
                                                                     Considered<M::kStates, B>& c)
  const {
    constexpr int kN = M::kStates, kM = S::kDimension, kC = motion::leading_columns(S::kParts), kS = S::kBiases;
    Sight<M, S> sight;
    if (!look<First>(sensor, z, c, sight)) return {};
    const Ldl<kM> ldl(sight.innovation.s);
    judge<kM>(sight.innovation, ldl);

    const linear::Matrix<kN, kM> gain = ldl.template divide<kN>(sight.w.transpose());
    c.state.x += gain * sight.innovation.nu;
    M::normalise(c.state.x);
    motion::add_scaled<kN, B>(c.cross, -1.0, motion::times<kN, kM, B>(gain, sight.with_bias));
    linear::Matrix<kN> t = c.state.p;
    motion::add_scaled<kN, kN>(t, -1.0, motion::times<kN, kM, kN>(gain, sight.w));
    linear::Matrix<kN, kM> e = motion::times_transposed<kN, kC, kM>(t.template leftCols<kC>(), sight.h);
    motion::add_scaled<kN, kM>(e, 1.0,
                               motion::times_transposed<kN, kS, kM>(c.cross.template middleCols<kS>(First), sight.d));
    motion::add_scaled<kN, kM>(e, -1.0, motion::times<kN, kM, kM>(gain, z.r));
    motion::add_scaled<kN, kN>(t, -1.0, motion::times_transposed<kN, kM, kN>(e, gain));
    c.state.p = t;
    linear::symmetrise<kN>(c.state.p);
    return sight.innovation;
  }

 private:
  template <class M, class S> struct Sight {
    linear::Matrix<S::kDimension, motion::leading_columns(S::kParts)> h;
    linear::Matrix<S::kDimension, S::kBiases> d;
    linear::Matrix<S::kDimension, M::kStates> w;  // cov(z, x)
    linear::Matrix<S::kDimension, B> with_bias;   // cov(z, b)
    Innovation<S::kDimension> innovation;         // without the fields that judge() sets
  };

  // Fills `sight`; returns false when the sensor cannot see the state, and the caller changes nothing.
  template <int First, motion::Model M, sensors::Biased S>
  bool look(const S& sensor, const sensors::Measurement<S::kDimension>& z, const Considered<M::kStates, B>& c,
            Sight<M, S>& sight) const {
    constexpr int kN = M::kStates, kM = S::kDimension, kC = motion::leading_columns(S::kParts), kS = S::kBiases;
    const motion::Kinematics k = M::template kinematics<S::kParts>(c.state.x);
    if (!sensor.sees(k)) return false;
    sight.h = measurement_matrix<M>(sensor, k, c.state.x);
    sight.d = sensor.bias_jacobian(k);
    const linear::Matrix<kC, kN> leading = c.state.p.template topRows<kC>();
    const linear::Matrix<kC, B> leading_cross = c.cross.template topRows<kC>();
    const linear::Matrix<kN, kS> own_cross = c.cross.template middleCols<kS>(First);
    const linear::Matrix<kS, B> own_bias = bias.template middleRows<kS>(First);
    sight.w = motion::times<kM, kC, kN>(sight.h, leading);
    motion::add_scaled<kM, kN>(sight.w, 1.0, motion::times_transposed<kM, kS, kN>(sight.d, own_cross));
    sight.with_bias = motion::times<kM, kC, B>(sight.h, leading_cross);
    motion::add_scaled<kM, B>(sight.with_bias, 1.0, motion::times<kM, kS, B>(sight.d, own_bias));
    linear::Matrix<kM>& s = sight.innovation.s;
    s = motion::times_transposed<kM, kC, kM>(sight.w.template leftCols<kC>(), sight.h) + z.r;
    motion::add_scaled<kM, kM>(
        s, 1.0, motion::times_transposed<kM, kS, kM>(sight.with_bias.template middleCols<kS>(First), sight.d));
    linear::symmetrise<kM>(s);
    sight.innovation.nu = sensor.residual(z.z, sensor.expected(k));
    return true;
  }
};

}  // namespace ttf::fusion::filters
