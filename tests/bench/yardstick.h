// What every benchmark here is read against: a chain of multiplications of which each waits for the one before, so that
// it takes the same number of cycles on every processor of the class, whatever else it is good at.
#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>

namespace ttf::bench {

// So that the compiler does not know the number. benchmark::DoNotOptimize (1.7) offers g++ 12 memory and a register for
// it, and may get one written and the other read: a time step came back as 7e-310.
inline void hide(double& value) { asm volatile("" : "+x"(value)); }

inline constexpr int kYardstickSteps = 100'000;

inline void Yardstick(benchmark::State& state) {
  std::uint64_t x = 1;
  for (auto _ : state) {
    benchmark::DoNotOptimize(x);  // where it starts is nothing the compiler knows
    for (int i = 0; i < kYardstickSteps; ++i) x = x * 6364136223846793005u + 1442695040888963407u;
    benchmark::DoNotOptimize(x);
  }
}
BENCHMARK(Yardstick)->Unit(benchmark::kMicrosecond);

}  // namespace ttf::bench
