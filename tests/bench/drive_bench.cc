// The cost of a simulated drive, with and without its log, against a yardstick measured in the same run.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "recording/log/writer.h"
#include "tests/bench/yardstick.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf {
namespace {

using sim::drives::Drive;

// A folder of this program's own, gone with it.
class ScratchFolder {
 public:
  ScratchFolder() : path_((std::filesystem::temp_directory_path() / "ttfusion_drive_bench_XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) throw std::runtime_error(path_ + ": cannot be created");
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

// As an experiment drives: the paper's 1.5 s, measured, without a log.
void PaperDriveMeasured(benchmark::State& state) {
  Drive drive("scenarios/paper_scenario1.yaml", static_cast<fusion::strategies::StrategyKind>(state.range(0)));
  drive.scenario.duration = Duration::milliseconds(1500);
  drive.scenario.evaluate_from = Duration{};
  std::uint64_t seed = 0;
  for (auto _ : state) {
    evaluation::accuracy::DriveMeasures measures(sim::drives::evaluation_start(drive.scenario));
    drive.run(measures, ++seed, false);
    benchmark::DoNotOptimize(measures.finish().position_rmse_truth);
  }
  state.counters["drives/s"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(PaperDriveMeasured)
    ->DenseRange(0, fusion::strategies::kStrategyCount - 1)
    ->ArgName("strategy")
    ->Unit(benchmark::kMillisecond);

void DriveWithoutLog(benchmark::State& state) {
  const Drive drive("scenarios/paper_scenario1.yaml", static_cast<fusion::strategies::StrategyKind>(state.range(0)));
  std::uint64_t seed = 0;
  for (auto _ : state) {
    recording::records::Sink nobody;
    benchmark::DoNotOptimize(drive.run(nobody, ++seed).frames_sent);
  }
  state.counters["drives/s"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["x real time"] =
      benchmark::Counter(drive.scenario.duration.seconds(), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(DriveWithoutLog)
    ->DenseRange(0, fusion::strategies::kStrategyCount - 1)
    ->ArgName("strategy")
    ->Unit(benchmark::kMillisecond);

void DriveWithLog(benchmark::State& state) {
  const Drive drive("scenarios/paper_scenario1.yaml", fusion::strategies::StrategyKind::kTt);
  const ScratchFolder scratch;
  const std::string path = scratch.file("drive.mcap");
  for (auto _ : state) {
    recording::log::LogWriter log(path, {});
    drive.run(log);
    log.close();
  }
}
BENCHMARK(DriveWithLog)->Unit(benchmark::kMillisecond);

void CrowdSecond(benchmark::State& state) {
  Drive drive("scenarios/crowd_25.yaml", fusion::strategies::StrategyKind::kAdva);
  drive.scenario.duration = Duration::milliseconds(1000);
  for (auto _ : state) {
    recording::records::Sink nobody;
    benchmark::DoNotOptimize(drive.run(nobody).frames_sent);
  }
}
BENCHMARK(CrowdSecond)->Unit(benchmark::kMillisecond);

// 20 s of six sensors round the car.
void twenty_seconds(benchmark::State& state, const char* scenario) {
  Drive drive(scenario, static_cast<fusion::strategies::StrategyKind>(state.range(0)));
  drive.scenario.duration = Duration::milliseconds(20'000);
  for (auto _ : state) {
    recording::records::Sink nobody;
    benchmark::DoNotOptimize(drive.run(nobody).frames_sent);
  }
  state.counters["x real time"] =
      benchmark::Counter(drive.scenario.duration.seconds(), benchmark::Counter::kIsIterationInvariantRate);
}

// 25 objects.
void SurroundWithoutLog(benchmark::State& state) { twenty_seconds(state, "scenarios/surround.yaml"); }
BENCHMARK(SurroundWithoutLog)
    ->DenseRange(0, fusion::strategies::kStrategyCount - 1)
    ->ArgName("strategy")
    ->Unit(benchmark::kMillisecond);

// The same sensors in a closed loop, with four objects.
void DrivenSurroundWithoutLog(benchmark::State& state) { twenty_seconds(state, "scenarios/blind_spot.yaml"); }
BENCHMARK(DrivenSurroundWithoutLog)
    ->DenseRange(0, fusion::strategies::kStrategyCount - 1)
    ->ArgName("strategy")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ttf

BENCHMARK_MAIN();
