// The cost of synthesis: drawn problems of 6 nodes, processors and static segment loaded to 70 %, half of the messages in chains.
// The argument is the seed. Counters are the largest age [us], its bound, and whether it is proven least. Memory [MiB] is the most
// that the program has had so far. A largest age of plain difference logic that its steps leave open is at most 1 s.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>

#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/generator.h"
#include "schedules/synthesis/smt/z3_prover.h"
#include "schedules/synthesis/solver/solve.h"

namespace ttf::schedules::synthesis {
namespace {

Problem drawn(const benchmark::State& state) { return generated({.seed = static_cast<std::uint64_t>(state.range(0))}); }

double most_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void count(benchmark::State& state, double age, double bound, bool proven) {
  state.counters["age"] = age;
  state.counters["bound"] = bound;
  state.counters["proven"] = proven;
  state.counters["MiB"] = most_memory();
}

void solve_largest(benchmark::State& state, solver::Prover* prover) {
  const Problem problem = drawn(state);
  const solver::Objective largest;
  solver::Outcome outcome;
  for (auto _ : state) outcome = solver::solve(problem, {&largest, 1}, {}, prover);
  if (!outcome.solution || !violations(problem, *outcome.solution).empty()) {
    state.SkipWithError("no solution");
    return;
  }
  count(state, outcome.reached[0].value, outcome.reached[0].bound, outcome.reached[0].proven);
}

void least_age_by_search(benchmark::State& state) { solve_largest(state, nullptr); }

void least_age_with_prover(benchmark::State& state) {
  smt::Z3Prover prover;
  solve_largest(state, &prover);
}

// The yardstick: difference logic alone halves the range from 0, as far as its steps go.
void least_age_by_differences(benchmark::State& state) {
  Problem problem = drawn(state);
  const solver::Repair none = [](const Solution&) { return std::nullopt; };
  Ticks least = 0, most = 0;
  for (auto _ : state) {
    smt::Z3Prover prover(smt::Logic::kDifferences, 10'000'000);
    least = 0;
    most = 1'000'000;
    for (double left = 1; least < most;) {
      const Ticks middle = least + (most - least) / 2;
      for (Chain& chain : problem.chains) chain.largest_age = middle;
      const solver::Verdict verdict = prover.decide({problem, {}, {}}, left, none);
      left -= verdict.spent;
      if (verdict.kind == solver::Verdict::Kind::kUnknown) break;
      if (verdict.kind == solver::Verdict::Kind::kInfeasible)
        least = middle + 1;
      else
        most = std::ranges::max(ages(problem, verdict.solution));
    }
  }
  count(state, static_cast<double>(most), static_cast<double>(least), least == most);
}

void thousand_messages(benchmark::State& state) {
  const Problem problem =
      generated({.tasks = 300, .messages = 1000, .seed = static_cast<std::uint64_t>(state.range(0))});
  for (auto _ : state)
    if (!solver::solve(problem, {}).solution) state.SkipWithError("no solution");
  state.counters["MiB"] = most_memory();
}

BENCHMARK(least_age_by_search)->DenseRange(1, 20)->Unit(benchmark::kMillisecond);
BENCHMARK(least_age_with_prover)->DenseRange(1, 20)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(least_age_by_differences)->DenseRange(1, 20)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(thousand_messages)->DenseRange(1, 5)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ttf::schedules::synthesis

BENCHMARK_MAIN();
