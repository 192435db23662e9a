// The unscented Kalman filter, scaled, with additive noise (Julier, Uhlmann: "Unscented filtering and nonlinear
// estimation", Proc. IEEE 92(3), 2004; van der Merwe: "Sigma-point Kalman filters", 2004).
//
// The sigma points are x and x +- sqrt(n + lambda) a_i. The a_i are the columns of a square root of P, and
// lambda = alpha^2 (n + kappa) - n. The centre has the weight lambda / (n + lambda), every other point
// 1 / (2 (n + lambda)). In covariances the centre's weight is larger by 1 - alpha^2 + beta. Means are formed
// from differences from the centre's image, by the models' difference and residual, so that angles average as
// angles.
//
// The default (alpha 1, beta 0, kappa 0) is the cubature rule of third degree (Arasaratnam, Haykin: "Cubature
// Kalman filters", IEEE TAC 54(6), 2009). It has no negative weight and loses no digits to large weights. It
// computes a quadratic's variance, 2 sigma^4, as (n - 1) sigma^4; in general the factor is alpha^2 (n - 1) +
// beta. A smaller alpha with beta 2 comes nearer to the true variance, with a negative weight of the centre.
//
// The filter uses a measurement only if the sensor sees every point: an unseen point has no image to average.
// For example, one point of a slow object may have a course and another point none.
//
// Each update draws new points, which include the process noise. The updated covariance is the sum of the
// points' own errors, sum w (dx - K dz)(dx - K dz)' + K R K'. This is the Joseph form of sigma points: it is
// positive for positive weights, whatever the rounding of K.
#pragma once

#include <cmath>

#include "fusion/filters/correct.h"
#include "fusion/motion/kernels.h"

namespace ttf::fusion::filters {

struct Unscented {
  static constexpr const char* kName = "Unscented";
  double alpha = 1.0, beta = 0.0, kappa = 0.0;

  template <motion::Model M> void predict(const M& model, linear::Gaussian<M::kStates>& state, double dt) const {
    constexpr int kN = M::kStates;
    const Weights w(*this, kN);
    const linear::Matrix<kN> noise = model.noise(state.x, dt), a = w.spread * square_root<kN>(state.p);
    const linear::Vector<kN> centre = model.move(state.x, dt);
    linear::Matrix<kN, 2 * kN> d;
    for (int i = 0; i < kN; ++i) {
      d.col(i) = M::difference(model.move(state.x + a.col(i), dt), centre);
      d.col(kN + i) = M::difference(model.move(state.x - a.col(i), dt), centre);
    }
    linear::Vector<kN> shift;
    state.p = w.spread_of<kN>(d, shift);
    motion::add_scaled<kN, kN>(state.p, 1.0, noise);
    state.x = centre + shift;
    M::normalise(state.x);
  }

  template <motion::Model M, sensors::Model S>
  Innovation<S::kDimension> innovate(const M& model, const S& sensor, const sensors::Measurement<S::kDimension>& z,
                                     const linear::Gaussian<M::kStates>& state) const {
    Sight<M, S> sight;
    if (!look(model, sensor, z, state, Weights(*this, M::kStates), sight)) return {};
    judge<S::kDimension>(sight.innovation, Ldl<S::kDimension>(sight.innovation.s));
    return sight.innovation;
  }

  template <motion::Model M, sensors::Model S>
  Innovation<S::kDimension> update(const M& model, const S& sensor, const sensors::Measurement<S::kDimension>& z,
                                   linear::Gaussian<M::kStates>& state) const {
    constexpr int kN = M::kStates, kM = S::kDimension;
    const Weights w(*this, kN);
    Sight<M, S> sight;
    if (!look(model, sensor, z, state, w, sight)) return {};
    Innovation<kM>& innovation = sight.innovation;
    const Ldl<kM> ldl(innovation.s);
    judge<kM>(innovation, ldl);

    // The points' dx are +-a, and zero for the centre.
    const linear::Matrix<kN>& a = sight.a;
    const linear::Matrix<kM, 2 * kN>& d = sight.d;
    const linear::Matrix<kM, kN> opposite = d.template leftCols<kN>() - d.template rightCols<kN>();
    linear::Matrix<kN, kM> crossed = linear::Matrix<kN, kM>::Zero();  // cov(x, z)
    motion::add_scaled<kN, kM>(crossed, w.other, motion::times_transposed<kN, kN, kM>(a, opposite));
    const linear::Matrix<kN, kM> gain = ldl.template divide<kN>(crossed);
    state.p = motion::sandwich<kN, kM>(gain, z.r);
    motion::add_outer<kN>(state.p, w.centre_of_covariance, gain * sight.shift);
    for (int i = 0; i < kN; ++i) {
      motion::add_outer<kN>(state.p, w.other, a.col(i) - gain * d.col(i));
      motion::add_outer<kN>(state.p, w.other, a.col(i) + gain * d.col(kN + i));
    }
    state.x += gain * innovation.nu;
    M::normalise(state.x);
    return innovation;
  }

 private:
  struct Weights {
    Weights(const Unscented& u, int n) {
      const double scale = u.alpha * u.alpha * (n + u.kappa);  // n + lambda
      spread = std::sqrt(scale);
      other = 0.5 / scale;
      centre_of_covariance = (scale - n) / scale + 1.0 - u.alpha * u.alpha + u.beta;
    }

    // Returns the covariance of the images d. Takes d as differences from the centre's image, returns it as
    // differences from the mean; `shift` is the mean minus the centre's image.
    template <int D, int Points>
    linear::Matrix<D> spread_of(linear::Matrix<D, Points>& d, linear::Vector<D>& shift) const {
      shift.setZero();
      for (int i = 0; i < Points; ++i) shift += other * d.col(i);
      linear::Matrix<D> sum = linear::Matrix<D>::Zero();
      motion::add_outer<D>(sum, centre_of_covariance, shift);
      for (int i = 0; i < Points; ++i) {
        d.col(i) -= shift;
        motion::add_outer<D>(sum, other, d.col(i));
      }
      return sum;
    }

    double spread, other, centre_of_covariance;
  };

  // The sigma points and their images: a, the points minus the centre, and d, the images minus their mean. The
  // mean is the centre's image plus `shift`.
  template <class M, class S> struct Sight {
    linear::Matrix<M::kStates> a;
    linear::Matrix<S::kDimension, 2 * M::kStates> d;
    linear::Vector<S::kDimension> shift;
    Innovation<S::kDimension> innovation;  // without the fields that judge() sets
  };

  // Fills `sight`; returns false when the sensor cannot see one of the points, and the caller changes nothing.
  template <motion::Model M, sensors::Model S>
  static bool look(const M&, const S& sensor, const sensors::Measurement<S::kDimension>& z,
                   const linear::Gaussian<M::kStates>& state, const Weights& w, Sight<M, S>& sight) {
    constexpr int kN = M::kStates, kM = S::kDimension;
    const motion::Kinematics at_centre = M::template kinematics<S::kParts>(state.x);
    if (!sensor.sees(at_centre)) return false;
    sight.a = w.spread * square_root<kN>(state.p);
    const linear::Vector<kM> centre = sensor.expected(at_centre);
    for (int i = 0; i < kN; ++i) {
      const linear::Vector<kN> above = state.x + sight.a.col(i), below = state.x - sight.a.col(i);
      const motion::Kinematics at_above = M::template kinematics<S::kParts>(above);
      const motion::Kinematics at_below = M::template kinematics<S::kParts>(below);
      if (!sensor.sees(at_above) || !sensor.sees(at_below)) return false;
      sight.d.col(i) = sensor.residual(sensor.expected(at_above), centre);
      sight.d.col(kN + i) = sensor.residual(sensor.expected(at_below), centre);
    }
    sight.innovation.s = w.template spread_of<kM>(sight.d, sight.shift) + z.r;
    sight.innovation.nu = sensor.residual(z.z, centre + sight.shift);
    return true;
  }
};

}  // namespace ttf::fusion::filters
