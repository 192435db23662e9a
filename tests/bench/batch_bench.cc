// Predictions and updates of many constant-velocity filters at once, four to a register, against one filter
// at a time. `pairs` counts prediction + update, for 100 filters and for 1,000. The latter's measurements fit
// the second-level cache.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <vector>

#include "fusion/batch/batch.h"
#include "fusion/filters/kalman.h"
#include "fusion/sensors/position.h"
#include "tests/bench/yardstick.h"

namespace ttf::fusion {
namespace {

const motion::ConstantVelocity kModel(2.0);
constexpr double kDt = 0.05;

// Objects go to and fro, so that no velocity decays to a denormal number.
sensors::Measurement<2> seen(std::size_t i, int turn) {
  const double to_and_fro = turn == 0 ? 0.2 : -0.3;
  return {{0.1 * static_cast<double>(i % 50) + to_and_fro, 0.05 * static_cast<double>(i % 31) - to_and_fro},
          0.04 * linear::Matrix<2>::Identity()};
}

void count(benchmark::State& state) {
  state.counters["pairs"] =
      benchmark::Counter(static_cast<double>(state.range(0) * state.iterations()), benchmark::Counter::kIsRate);
}

void OneAtATime(benchmark::State& state) {
  const auto filters_there = static_cast<std::size_t>(state.range(0));
  linear::Gaussian<4> prior;
  prior.p.setIdentity();
  std::vector<linear::Gaussian<4>> tracks(filters_there, prior);
  std::vector<sensors::Measurement<2>> z[2];
  for (std::size_t i = 0; i < filters_there; ++i)
    for (int turn = 0; turn < 2; ++turn) z[turn].push_back(seen(i, turn));
  const filters::Kalman filter;
  double dt = kDt;
  int turn = 0;
  for (auto _ : state) {
    bench::hide(dt);
    turn = 1 - turn;
    for (std::size_t i = 0; i < filters_there; ++i) {
      filter.predict(kModel, tracks[i], dt);
      filter.update(kModel, sensors::Position{}, z[turn][i], tracks[i]);
    }
    benchmark::ClobberMemory();
  }
  count(state);
}

template <template <class> class Form> void AtOnce(benchmark::State& state) {
  const auto filters_there = static_cast<std::size_t>(state.range(0));
  linear::Gaussian<4> prior;
  prior.p.setIdentity();
  batch::Batch<Form> batch(filters_there);
  batch::Positions z[2] = {batch::Positions(filters_there), batch::Positions(filters_there)};
  for (std::size_t i = 0; i < filters_there; ++i) {
    batch.set(i, prior);
    for (int turn = 0; turn < 2; ++turn) z[turn].set(i, seen(i, turn));
  }
  double dt = kDt;
  int turn = 0;
  for (auto _ : state) {
    bench::hide(dt);
    turn = 1 - turn;
    batch.step(batch::Step(kModel, dt), z[turn]);
    benchmark::ClobberMemory();
  }
  count(state);
}

BENCHMARK(OneAtATime)->Arg(100)->Arg(1000);
BENCHMARK(AtOnce<batch::Axes>)->Name("AxesAtOnce")->Arg(100)->Arg(1000);
BENCHMARK(AtOnce<batch::Joint>)->Name("JointAtOnce")->Arg(100)->Arg(1000);

}  // namespace
}  // namespace ttf::fusion

BENCHMARK_MAIN();
