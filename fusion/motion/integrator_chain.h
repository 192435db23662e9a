// A chain of integrators moves both axes alike: each component is the integral of the next one of its axis, and
// white noise drives the last one. With K components per axis in the order (x, y, vx, vy, ...), F = f (x) I and
// Q = q (x) diag(s_x, s_y), with a spectral density for each axis. The matrix f is upper triangular with
// f_ij = dt^(j-i) / (j-i)!. The matrix q is the exact integral (Bar-Shalom, Li, Kirubarajan: "Estimation with
// Applications to Tracking and Navigation", 2001, 6.2.2 and 6.2.3):
//   q_ij = dt^(a+b+1) / (a! b! (a+b+1)),   a = K-1-i, b = K-1-j.
#pragma once

#include "core/check.h"
#include "fusion/motion/kernels.h"
#include "fusion/motion/motion_model.h"

namespace ttf::fusion::motion {

template <int K> struct IntegratorChain : Cartesian<2 * K> {
  static constexpr int kStates = 2 * K;
  static constexpr bool kLinear = true;

  double spectral_density = 1.0;  // of the noise that drives x [m^2/s^(2K-1)], >= 0
  double cross_density = 1.0;     // the same for y
  double drift_density = 0.0;     // spectral density of a walk of the position beside it [m^2/s], >= 0

  linear::Vector<kStates> move(const linear::Vector<kStates>& x, double dt) const {
    linear::Vector<kStates> moved = x;
    advance_rows(moved, dt);
    return moved;
  }
  linear::Matrix<kStates> jacobian(const linear::Vector<kStates>&, double dt) const {
    linear::Matrix<kStates> f = linear::Matrix<kStates>::Identity();
    advance_rows(f, dt);
    return f;
  }
  linear::Matrix<kStates> noise(const linear::Vector<kStates>&, double dt) const {
    linear::Matrix<kStates> q = linear::Matrix<kStates>::Zero();
    add_noise(q, dt);
    return q;
  }
  linear::LinearStep<kStates> step(double dt) const {
    const linear::Vector<kStates> anywhere = linear::Vector<kStates>::Zero();
    return {jacobian(anywhere, dt), noise(anywhere, dt)};
  }

  // Computes F P F' + Q: F P F' as sums of rows, then of columns. Flattened, so that all powers are computed once.
  [[gnu::flatten]] void advance(linear::Gaussian<kStates>& state, double dt) const {
    TTF_CHECK(dt >= 0.0, "prediction by {} s", dt);
    advance_rows(state.x, dt);
    advance_rows(state.p, dt);
    advance_columns(state.p, dt);
    mirror<kStates>(state.p);
    add_noise(state.p, dt);
  }

 private:
  static constexpr double factorial(int n) { return n <= 1 ? 1.0 : n * factorial(n - 1); }
  static double power(double dt, int n) { return n == 0 ? 1.0 : n == 1 ? dt : dt * power(dt, n - 1); }

  static double step_by(double dt, int n) { return power(dt, n) * (1.0 / factorial(n)); }

  // Goes from the top downwards: the rows below still have their old values.
  template <class Rows> static void advance_rows(Rows& a, double dt) {
    unrolled<K>([&](auto i) {
      unrolled<K - 1 - i>([&](auto below) {
        constexpr int kSteps = below + 1;
        a.template middleRows<2>(2 * i) += step_by(dt, kSteps) * a.template middleRows<2>(2 * (i + kSteps));
      });
    });
  }
  static void advance_columns(linear::Matrix<kStates>& a, double dt) {
    unrolled<K>([&](auto i) {
      unrolled<K - 1 - i>([&](auto right) {
        constexpr int kSteps = right + 1;
        a.template middleCols<2>(2 * i) += step_by(dt, kSteps) * a.template middleCols<2>(2 * (i + kSteps));
      });
    });
  }
  void add_noise(linear::Matrix<kStates>& p, double dt) const {
    unrolled<K>([&](auto i) {
      unrolled<K>([&](auto j) {
        constexpr int a = K - 1 - i, b = K - 1 - j;
        constexpr double kShare = 1.0 / (factorial(a) * factorial(b) * (a + b + 1));
        p(2 * i, 2 * j) += spectral_density * power(dt, a + b + 1) * kShare;
        p(2 * i + 1, 2 * j + 1) += cross_density * power(dt, a + b + 1) * kShare;
      });
    });
    if (drift_density > 0.0) {
      p(0, 0) += drift_density * dt;
      p(1, 1) += drift_density * dt;
    }
  }
};

}  // namespace ttf::fusion::motion
