// What a simulated drive costs, with and without its log, against a yardstick measured in the same run.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <string>

#include "recording/log_writer.h"
#include "tests/sim/drive_fixture.h"

namespace ttf {
namespace {

using testing_support::Drive;

// The yardstick: a second of work everybody has, an in-order chain of multiplications.
void Yardstick(benchmark::State& state) {
  for (auto _ : state) {
    std::uint64_t x = 1;
    for (int i = 0; i < 1'000'000; ++i) x = x * 6364136223846793005u + 1442695040888963407u;
    benchmark::DoNotOptimize(x);
  }
}
BENCHMARK(Yardstick)->Unit(benchmark::kMillisecond);

void DriveWithoutLog(benchmark::State& state) {
  const Drive drive("scenarios/paper_scenario1.yaml", static_cast<fusion::StrategyKind>(state.range(0)));
  std::uint64_t seed = 0;
  for (auto _ : state) {
    records::Sink nobody;
    benchmark::DoNotOptimize(drive.run(nobody, ++seed).frames_sent);
  }
  state.counters["drives/s"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["x real time"] = benchmark::Counter(drive.scenario.duration.seconds(),
                                                     benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(DriveWithoutLog)->Arg(0)->Arg(1)->Arg(2)->ArgName("strategy")->Unit(benchmark::kMillisecond);

void DriveWithLog(benchmark::State& state) {
  const Drive drive("scenarios/paper_scenario1.yaml", fusion::StrategyKind::kTt);
  const std::string path = "/tmp/ttfusion_drive_bench.mcap";
  for (auto _ : state) {
    recording::LogWriter log(path, {});
    drive.run(log);
    log.close();
  }
  std::remove(path.c_str());
}
BENCHMARK(DriveWithLog)->Unit(benchmark::kMillisecond);

void CrowdSecond(benchmark::State& state) {
  Drive drive("scenarios/crowd_25.yaml", fusion::StrategyKind::kAdva);
  drive.scenario.duration = Duration::milliseconds(1000);
  for (auto _ : state) {
    records::Sink nobody;
    benchmark::DoNotOptimize(drive.run(nobody).frames_sent);
  }
}
BENCHMARK(CrowdSecond)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ttf

BENCHMARK_MAIN();
