// Steps of a covariance, put together: flows, measurements, rounds of both (periodic_error.h has the equations).
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace ttf::experiments::judges {

template <int K> using Square = Eigen::Matrix<double, K, K>;

// The map P -> h + a P (I + g P)^-1 a'.
template <int K> struct Steps {
  Square<K> a = Square<K>::Identity(), g = Square<K>::Zero(), h = Square<K>::Zero();

  // Returns this map, and then the next one.
  Steps then(const Steps& next) const {
    const Square<K> w = (Square<K>::Identity() + h * next.g).inverse();
    return {next.a * w * a, g + a.transpose() * next.g * w * a, next.h + next.a * w * h * next.a.transpose()};
  }
  Square<K> of(const Square<K>& p) const {
    return h + a * p * (Square<K>::Identity() + g * p).inverse() * a.transpose();
  }
};

// Returns the step over `dt` seconds, with noise of this density on the last state.
template <int K> Steps<K> moved(double dt, double density) {
  Steps<K> step;
  if constexpr (K == 1) {
    step.h(0, 0) = density * dt;
  } else {
    step.a(0, 1) = dt;
    step.h << dt * dt * dt / 3.0, dt * dt / 2.0, dt * dt / 2.0, dt;
    step.h *= density;
  }
  return step;
}

// Returns the step of a measurement of the position.
template <int K> Steps<K> informed(double variance) {
  Steps<K> step;
  step.g(0, 0) = 1.0 / variance;
  return step;
}

// Returns the covariance behind infinitely many of these steps.
template <int K> Square<K> periodic(Steps<K> rounds) {
  constexpr int kMostDoublings = 48;
  for (int doubling = 0; doubling < kMostDoublings; ++doubling) {
    const Steps<K> twice = rounds.then(rounds);
    const bool ended = (twice.h - rounds.h).cwiseAbs().maxCoeff() <= 1e-15 * twice.h.cwiseAbs().maxCoeff();
    rounds = twice;
    if (ended) break;
  }
  return rounds.h;
}

}  // namespace ttf::experiments::judges
