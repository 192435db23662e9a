// One prediction and one update with a position, constant velocity (n = 4) and constant acceleration (n = 6).
// One way uses the vocabulary of fusion/filters, the other plain fixed-size Eigen written for one model. The
// interface shall cost nothing: level or ahead. `pairs` counts prediction + update.
#include <benchmark/benchmark.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "fusion/filters/extended.h"
#include "fusion/motion/constant_acceleration.h"
#include "fusion/motion/constant_velocity.h"
#include "fusion/sensors/position.h"
#include "tests/bench/yardstick.h"

namespace ttf::fusion {
namespace {

constexpr double kDt = 0.05;
constexpr int kBatch = 100;  // steps between looks at the clock

// Positions along a wavy line.
struct Seen {
  linear::Vector<2> z[kBatch];
  Seen() {
    for (int i = 0; i < kBatch; ++i) z[i] = {0.1 * i + 0.3 * ((i * 7) % 5), 0.05 * i - 0.2 * ((i * 3) % 4)};
  }
};

void count(benchmark::State& state) {
  state.counters["pairs"] =
      benchmark::Counter(kBatch * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

template <class F, class M> void Interface(benchmark::State& state) {
  const Seen seen;
  const M model(2.0);
  const F filter;
  linear::Gaussian<M::kStates> estimate;
  estimate.p.setIdentity();
  double dt = kDt;
  sensors::Measurement<2> z{.r = 0.04 * linear::Matrix<2>::Identity()};
  for (auto _ : state) {
    bench::hide(dt);
    for (int i = 0; i < kBatch; ++i) {
      z.z = seen.z[i];
      filter.predict(model, estimate, dt);
      filter.update(model, sensors::Position{}, z, estimate);
    }
    benchmark::DoNotOptimize(estimate);
  }
  count(state);
}

// F and Q of the model, as matrices.
template <int N> linear::LinearStep<N> written_out(double dt) {
  linear::LinearStep<N> step;
  const double q = 2.0;
  for (int a = 0; a < 2; ++a) {
    if constexpr (N == 4) {
      step.f(a, a + 2) = dt;
      step.q(a, a) = q * dt * dt * dt / 3.0;
      step.q(a, a + 2) = step.q(a + 2, a) = q * dt * dt / 2.0;
      step.q(a + 2, a + 2) = q * dt;
    } else {
      step.f(a, a + 2) = step.f(a + 2, a + 4) = dt;
      step.f(a, a + 4) = 0.5 * dt * dt;
      const double dt2 = dt * dt, dt3 = dt2 * dt;
      step.q(a, a) = q * dt3 * dt2 / 20.0;
      step.q(a, a + 2) = step.q(a + 2, a) = q * dt2 * dt2 / 8.0;
      step.q(a, a + 4) = step.q(a + 4, a) = q * dt3 / 6.0;
      step.q(a + 2, a + 2) = q * dt3 / 3.0;
      step.q(a + 2, a + 4) = step.q(a + 4, a + 2) = q * dt2 / 2.0;
      step.q(a + 4, a + 4) = q * dt;
    }
  }
  return step;
}

enum class Form { kJoseph, kShort };

// Short: P - K H P and the inverse of S in closed form, the fastest usual way.
template <int N, Form form> void PlainEigen(benchmark::State& state) {
  const Seen seen;
  linear::Gaussian<N> estimate;
  estimate.p.setIdentity();
  double dt = kDt;
  linear::Matrix<2, N> h = linear::Matrix<2, N>::Zero();
  h(0, 0) = h(1, 1) = 1.0;
  const linear::Matrix<2> r = 0.04 * linear::Matrix<2>::Identity();
  for (auto _ : state) {
    bench::hide(dt);
    for (int i = 0; i < kBatch; ++i) {
      const linear::LinearStep<N> step = written_out<N>(dt);
      estimate.x = step.f * estimate.x;
      estimate.p = step.f * estimate.p * step.f.transpose() + step.q;
      const linear::Matrix<2, N> hp = h * estimate.p;
      const linear::Matrix<2> s = hp * h.transpose() + r;
      if constexpr (form == Form::kJoseph) {
        const linear::Matrix<N, 2> k = s.ldlt().solve(hp).transpose();
        estimate.x += k * (seen.z[i] - h * estimate.x);
        const linear::Matrix<N> a = linear::Matrix<N>::Identity() - k * h;
        estimate.p = a * estimate.p * a.transpose() + k * r * k.transpose();
      } else {
        const double determinant = s(0, 0) * s(1, 1) - s(0, 1) * s(1, 0);
        linear::Matrix<2> inverse;
        inverse << s(1, 1) / determinant, -s(0, 1) / determinant, -s(1, 0) / determinant, s(0, 0) / determinant;
        const linear::Matrix<N, 2> k = hp.transpose() * inverse;
        estimate.x += k * (seen.z[i] - h * estimate.x);
        estimate.p -= k * hp;
      }
    }
    benchmark::DoNotOptimize(estimate);
  }
  count(state);
}

BENCHMARK(Interface<filters::Kalman, motion::ConstantVelocity>)->Name("Interface/n:4");
BENCHMARK(PlainEigen<4, Form::kJoseph>)->Name("PlainEigenJoseph/n:4");
BENCHMARK(PlainEigen<4, Form::kShort>)->Name("PlainEigenShort/n:4");
BENCHMARK(Interface<filters::Kalman, motion::ConstantAcceleration>)->Name("Interface/n:6");
BENCHMARK(PlainEigen<6, Form::kJoseph>)->Name("PlainEigenJoseph/n:6");
BENCHMARK(PlainEigen<6, Form::kShort>)->Name("PlainEigenShort/n:6");

}  // namespace
}  // namespace ttf::fusion

BENCHMARK_MAIN();
