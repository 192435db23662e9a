// The cost of one late measurement, n = 4, m = 2, constant velocity in the plane, at 1, 3, 5 and 10 lags; and
// of one in order. The aim is 0.3 microseconds at lag 3, and a clone that costs the same at every lag.
//
// `Plain` is the comparison: one prediction and update in order, written with fixed-size Eigen only. The
// timed part is one take(), each by a copy of the method made outside of it. The clock costs some 20 ns a
// time, so a batch of copies takes at once.
#include <benchmark/benchmark.h>

#include <Eigen/LU>
#include <chrono>
#include <vector>

#include "tests/bench/yardstick.h"
#include "tests/fusion/oosm/any_method.h"
#include "tests/fusion/oosm/timelines.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::oosm {
namespace {

using Plane = ConstantVelocity<2>;
using Measurement = linear::LinearMeasurement<4, 2>;

constexpr int kLists = 15, kBatch = 32, kCapacity = 16;

Measurement position(double x, double y) {
  Measurement measurement;
  measurement.z = linear::Vector<2>(x, y);
  measurement.h(0, 0) = measurement.h(1, 2) = 1.0;
  measurement.r = 0.5 * linear::Matrix<2>::Identity();
  return measurement;
}

// A method that took kLists lists, 40 ms apart, and expects one from between to come `lag` late (0: in
// order).
template <class X> X prepared(X method, const Stamp& awaited) {
  method.start(GlobalTime{}, {linear::Vector<4>::Zero(), linear::Matrix<4>::Identity()});
  for (int i = 1; i <= kLists; ++i) {
    method.announce(awaited);
    method.take(stamp_at(after_ms(40 * i)), position(i, -i));
  }
  return method;
}

template <class X> void Take(benchmark::State& state) {
  const auto lag = state.range(0);
  const Stamp stamp = stamp_at(after_ms(40 * (kLists - lag) + 20), 1);
  const Measurement measurement = position(kLists, -kLists);
  const X ready = prepared(X(Plane{}), stamp);
  std::vector<X> copies(kBatch, ready);
  std::int64_t allocations = 0;
  for (auto _ : state) {
    for (X& copy : copies) copy = ready;
    const std::int64_t before = support::allocations();
    const auto begin = std::chrono::steady_clock::now();
    for (X& copy : copies) benchmark::DoNotOptimize(copy.take(stamp, measurement));
    const auto end = std::chrono::steady_clock::now();
    allocations += support::allocations() - before;
    state.SetIterationTime(std::chrono::duration<double>(end - begin).count() / kBatch);
  }
  X once = ready;
  const Taken expected = lag == 0 ? Taken::kInOrder : Taken::kLate;
  if (once.take(stamp, measurement) != expected) state.SkipWithError("was not taken");
  if (allocations != 0) state.SkipWithError("the measured part allocates");
}

// Textbook form, one instant after the other.
void Plain(benchmark::State& state) {
  const Plane motion;
  const Measurement measurement = position(1.0, -1.0);
  linear::Gaussian<4> now{linear::Vector<4>::Zero(), linear::Matrix<4>::Identity()};
  double dt = 0.04;
  for (auto _ : state) {
    bench::hide(dt);
    const linear::LinearStep<4> step = motion.step(dt);
    const linear::Vector<4> x = step.f * now.x;
    const linear::Matrix<4> p = step.f * now.p * step.f.transpose() + step.q;
    const linear::Matrix<2> s = measurement.h * p * measurement.h.transpose() + measurement.r;
    const linear::Matrix<4, 2> k = p * measurement.h.transpose() * s.inverse();
    const linear::Matrix<4> rest = linear::Matrix<4>::Identity() - k * measurement.h;
    now.x = x + k * (measurement.z - measurement.h * x);
    now.p = rest * p * rest.transpose() + k * measurement.r * k.transpose();
    benchmark::DoNotOptimize(now);
  }
}
BENCHMARK(Plain);

void one_lag(benchmark::internal::Benchmark* b) { b->Arg(0)->Arg(1)->ArgName("lag")->UseManualTime(); }
void lags(benchmark::internal::Benchmark* b) {
  b->Arg(0)->Arg(1)->Arg(3)->Arg(5)->Arg(10)->ArgName("lag")->UseManualTime();
}

using OfRewind = Rewind<4, 2, Plane, kCapacity>;
using OfAugmented = Augmented<4, 2, Plane, kCapacity>;
using OfClone = Clone<4, 2, Plane, 8>;
using OfAdjoint = Adjoint<4, 2, Plane, kCapacity>;
using OfAl1 = Al1<4, 2, Plane, kCapacity>;
using OfBl1 = Bl1<4, 2, Plane, kCapacity>;
BENCHMARK_TEMPLATE(Take, OfRewind)->Apply(lags);
BENCHMARK_TEMPLATE(Take, OfAugmented)->Apply(lags);
BENCHMARK_TEMPLATE(Take, OfClone)->Apply(lags);
BENCHMARK_TEMPLATE(Take, OfAdjoint)->Apply(lags);
BENCHMARK_TEMPLATE(Take, OfAl1)->Apply(lags);
BENCHMARK_TEMPLATE(Take, OfBl1)->Apply(lags);
using OfA = AlgorithmA<4, 2, Plane>;
using OfB = AlgorithmB<4, 2, Plane>;
using OfC = AlgorithmC<4, 2, Plane>;
BENCHMARK_TEMPLATE(Take, OfA)->Apply(one_lag);
BENCHMARK_TEMPLATE(Take, OfB)->Apply(one_lag);
BENCHMARK_TEMPLATE(Take, OfC)->Apply(one_lag);

}  // namespace
}  // namespace ttf::fusion::oosm

BENCHMARK_MAIN();
