// The comparison for every benchmark here: a chain of multiplications, each waiting for the one before. It
// takes the same number of cycles on every processor of the class.
#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>

namespace ttf::bench {

// Hides the number from the compiler. benchmark::DoNotOptimize (1.7) offers g++ 12 memory and a register for
// it, and may get one written and the other read: a time step came back as 7e-310.
inline void hide(double& value) { asm volatile("" : "+x"(value)); }

inline constexpr int kYardstickSteps = 100'000;

inline void Yardstick(benchmark::State& state) {
  std::uint64_t x = 1;
  for (auto _ : state) {
    benchmark::DoNotOptimize(x);  // hides the start value from the compiler
    for (int i = 0; i < kYardstickSteps; ++i) x = x * 6364136223846793005u + 1442695040888963407u;
    benchmark::DoNotOptimize(x);
  }
}
BENCHMARK(Yardstick)->Unit(benchmark::kMicrosecond);

}  // namespace ttf::bench
