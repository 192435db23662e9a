// Coordinated turns have a constant turn rate and constant speed (CTRV) or constant acceleration along the
// heading (CTRA). Schubert, Richter, Wanielik: "Comparison and evaluation of advanced motion models for vehicle
// tracking", FUSION 2008. Here the equations use the moments of turn_moments.h, so they hold at any turn rate,
// zero included.
//
// The symbols are heading h, speed v, turn rate w, acceleration a, u = w dt, and the turned moments
//   C_k = cos h c_k - sin h s_k,  S_k = sin h c_k + cos h s_k:
//   x += v dt C_0 + a dt^2 C_1,  y += v dt S_0 + a dt^2 S_1,  h += w dt,  v += a dt.
//
// White turn acceleration drives the turn rate. White acceleration drives the speed (CTRV), or white jerk the
// acceleration (CTRA). The noise covariance is int F(dt-s) G diag(q) G' F(dt-s)' ds along the path of x
// (Saerkkae, Solin: "Applied Stochastic Differential Equations", 2019). Four-point Gauss-Legendre quadrature
// takes the integral. It is exact for straight motion; its relative error is below 1e-5 for |w dt| <= 0.5.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "core/check.h"
#include "fusion/motion/angles.h"
#include "fusion/motion/kernels.h"
#include "fusion/motion/motion_model.h"
#include "fusion/motion/turn_moments.h"

namespace ttf::fusion::motion {

template <int N> struct CoordinatedTurn : Polar<N> {
  using Layout = Polar<N>;
  static constexpr int kStates = N;
  static constexpr bool kLinear = false;
  static constexpr bool kAccelerates = N == 6;

  double turn_density = 1.0;   // spectral density of the turn acceleration [rad^2/s^3], >= 0
  double along_density = 1.0;  // spectral density of the acceleration [m^2/s^3] or the jerk [m^2/s^5], >= 0
  double drift_density = 0.0;  // spectral density of a walk of the position beside it [m^2/s], >= 0

  linear::Vector<N> move(const linear::Vector<N>& x, double dt) const {
    TTF_CHECK(dt >= 0.0, "prediction by {} s", dt);
    const Turned m(x, dt);
    linear::Vector<N> moved = x;
    moved(0) += x(3) * dt * m.c[0];
    moved(1) += x(3) * dt * m.s[0];
    if constexpr (kAccelerates) {
      moved(0) += x(5) * dt * dt * m.c[1];
      moved(1) += x(5) * dt * dt * m.s[1];
      moved(3) += x(5) * dt;
    }
    moved(2) = to_half_turn(x(2) + x(4) * dt);
    return moved;
  }

  linear::Matrix<N> jacobian(const linear::Vector<N>& x, double dt) const {
    const Turned m(x, dt);
    const double v = x(3) * dt, by_rate = x(3) * dt * dt;
    linear::Matrix<N> f = linear::Matrix<N>::Identity();
    f(0, 2) = -v * m.s[0];
    f(1, 2) = v * m.c[0];
    f(0, 3) = dt * m.c[0];
    f(1, 3) = dt * m.s[0];
    f(0, 4) = -by_rate * m.s[1];
    f(1, 4) = by_rate * m.c[1];
    f(2, 4) = dt;
    if constexpr (kAccelerates) {
      const double a = x(5) * dt * dt;
      f(0, 2) -= a * m.s[1];
      f(1, 2) += a * m.c[1];
      f(0, 4) -= a * dt * m.s[2];
      f(1, 4) += a * dt * m.c[2];
      f(0, 5) = dt * dt * m.c[1];
      f(1, 5) = dt * dt * m.s[1];
      f(3, 5) = dt;
    }
    return f;
  }

  linear::Matrix<N> noise(const linear::Vector<N>& x, double dt) const {
    constexpr double kInner = 0.33998104358485626, kOuter = 0.86113631159405258;  // sqrt(3/7 -+ 2/7 sqrt(6/5))
    constexpr double kHeavy = 0.32607257743127307, kLight = 0.17392742256872693;  // (18 +- sqrt(30)) / 72
    constexpr double kNodes[] = {-kOuter, -kInner, kInner, kOuter}, kWeights[] = {kLight, kHeavy, kHeavy, kLight};
    linear::Matrix<N> q = linear::Matrix<N>::Zero();
    for (int i = 0; i < 4; ++i) {
      const double done = 0.5 * dt * (1.0 + kNodes[i]);
      const linear::Matrix<N> f = jacobian(turned(x, done), dt - done);
      constexpr int kDriven = kAccelerates ? 5 : 3;
      const double by_turn = kWeights[i] * dt * turn_density, by_speed = kWeights[i] * dt * along_density;
      unrolled<N>([&](auto column) {
        constexpr int c = column;
        unrolled<c + 1>([&](int r) {
          q(r, c) += by_turn * (f(r, 4) * f(c, 4));
          q(r, c) += by_speed * (f(r, kDriven) * f(c, kDriven));
        });
      });
    }
    mirror<N>(q);
    if (drift_density > 0.0) {
      q(0, 0) += drift_density * dt;
      q(1, 1) += drift_density * dt;
    }
    return q;
  }

 private:
  // Moves all components except the position; no derivative depends on the position.
  static linear::Vector<N> turned(linear::Vector<N> x, double dt) {
    x(2) = to_half_turn(x(2) + x(4) * dt);
    if constexpr (kAccelerates) x(3) += x(5) * dt;
    return x;
  }

  struct Turned {
    Turned(const linear::Vector<N>& x, double dt) {
      const TurnMoments m = turn_moments(x(4) * dt);
      const double cos = std::cos(x(2)), sin = std::sin(x(2));
      for (std::size_t k = 0; k < 3; ++k) {
        c[k] = cos * m.c[k] - sin * m.s[k];
        s[k] = sin * m.c[k] + cos * m.s[k];
      }
    }
    std::array<double, 3> c, s;
  };
};

}  // namespace ttf::fusion::motion
