// The cost of one fusion cycle with 25 objects, and with 1,000. The paper's budget is 10 ms. The aims for 25 cars
// of which sensors see ends and silhouettes are 60 us with straight models, 120 with turning and 250 with interacting
// ones, and for 1,000 objects 45 times as long as for 25 (docs/fusion/tracker.md says what is reached).
//
// Each measured step starts from a strategy that has tracked the 25 objects for as long as its history
// reaches. Every benchmark also counts the allocations of its measured part: any allocation is an error.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/bench/crowd.h"
#include "tests/bench/yardstick.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion {
namespace {

void report_allocations(benchmark::State& state, std::int64_t allocations) {
  state.counters["allocations"] = static_cast<double>(allocations);
  if (allocations != 0) state.SkipWithError("the measured part allocates");
}

// Two lists of all objects in, image out. A late laser list comes after the camera's, which is younger.
void cycle(benchmark::State& state, const Crowd& crowd, strategies::StrategyKind kind,
           const config::TrackerConfig& config, bool laser_is_late = false) {
  const auto objects = static_cast<std::size_t>(config.max_objects);
  const std::size_t cycles = crowd.laser.size();
  std::vector<tracks::TrackView> image;
  image.reserve(objects);
  std::unique_ptr<strategies::Strategy> strategy;
  std::size_t k = cycles;
  std::int64_t allocations = 0;
  for (auto _ : state) {
    if (k == cycles) {
      state.PauseTiming();
      strategy = crowd.start(kind, kWarm, config);
      k = kWarm;
      state.ResumeTiming();
    }
    const std::int64_t before_all = support::allocations();
    if (laser_is_late) {
      strategy->accept(crowd.camera[k].view());
      strategy->fuse(crowd.camera[k].measured + Duration::milliseconds(40));
      strategy->accept(crowd.laser[k].view());
    } else {
      strategy->accept(crowd.laser[k].view());
      strategy->accept(crowd.camera[k].view());
    }
    strategy->fuse(crowd.camera[k].measured + Duration::milliseconds(60));
    strategy->image(crowd.camera[k].measured + Duration::milliseconds(100), image);
    allocations += support::allocations() - before_all;
    ++k;
  }
  if (image.size() != objects) state.SkipWithError("not all objects are tracked");
  report_allocations(state, allocations);
}
void Cycle(benchmark::State& state) {
  cycle(state, scene(), static_cast<strategies::StrategyKind>(state.range(0)), {});
}
BENCHMARK(Cycle)->DenseRange(0, strategies::kStrategyCount - 1)->ArgName("strategy")->Unit(benchmark::kMicrosecond);

// The same, time-triggered, under every motion model (fusion/config/tracker_config.h) and filter.
void CycleOf(benchmark::State& state) {
  cycle(state, scene(), strategies::StrategyKind::kTt,
        config_of(static_cast<config::MotionModel>(state.range(0)), 3.0,
                  static_cast<config::FilterKind>(state.range(1))));
}
BENCHMARK(CycleOf)
    ->ArgsProduct({{0, 1, 2, 3, 4}, {0, 1}})
    ->ArgNames({"motion", "filter"})
    ->Unit(benchmark::kMicrosecond);

// The same with cars, of which the laser sees an end and the camera the silhouette.
void CycleOnTheRoad(benchmark::State& state) {
  cycle(state, road(), strategies::StrategyKind::kTt,
        config_of(static_cast<config::MotionModel>(state.range(0)), 3.0,
                  static_cast<config::FilterKind>(state.range(1))));
}
BENCHMARK(CycleOnTheRoad)
    ->ArgsProduct({{0, 1, 2, 3, 4}, {0, 1}})
    ->ArgNames({"motion", "filter"})
    ->Unit(benchmark::kMicrosecond);

// The same, constant velocity or acceleration, where eight biases are considered (fusion/sensors/known_sensor.h).
void CycleConsidering(benchmark::State& state) {
  config::TrackerConfig config = config_of(static_cast<config::MotionModel>(state.range(0)));
  config.systematic = config::SystematicErrorsAre::kConsidered;
  config.sensors.resize(2);
  config.sensors[0].errors.sigma << 0.1, 0.005, 0.1, 0.005;
  config.sensors[1].errors.sigma << 0.2, 0.01, 0.1, 0.005;
  Crowd crowd = scene();
  for (std::vector<OwnedList>* lists : {&crowd.laser, &crowd.camera})
    for (OwnedList& list : *lists)
      for (sensors::Observation& z : list.observations) z.sensor = list.id.sensor;
  cycle(state, crowd, strategies::StrategyKind::kTt, config);
}
BENCHMARK(CycleConsidering)->Arg(0)->Arg(1)->ArgName("motion")->Unit(benchmark::kMicrosecond);

// ADVA with one late list in every cycle, by every method for late lists (fusion/oosm/kind.h).
void CycleWithALateList(benchmark::State& state) {
  config::TrackerConfig config;
  config.late = oosm::kKinds[static_cast<std::size_t>(state.range(0))].kind;
  state.SetLabel(std::string(oosm::name_of(config.late)));
  cycle(state, scene(), strategies::StrategyKind::kAdva, config, true);
}
BENCHMARK(CycleWithALateList)->DenseRange(0, oosm::kKinds.size() - 1)->ArgName("late")->Unit(benchmark::kMicrosecond);

// The same under ADVA with more objects, and the time for each.
void cycle_of_many(benchmark::State& state, Locates locates) {
  const auto objects = static_cast<int>(state.range(0));
  cycle(state, crowd_of(objects, locates), strategies::StrategyKind::kAdva, for_crowd_of(objects));
  state.counters["each"] = benchmark::Counter(
      static_cast<double>(objects), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
void CycleOfMany(benchmark::State& state) { cycle_of_many(state, Locates::kCentres); }
BENCHMARK(CycleOfMany)->Arg(25)->Arg(100)->Arg(300)->Arg(1000)->ArgName("objects")->Unit(benchmark::kMicrosecond);
void CycleOfManyOnTheRoad(benchmark::State& state) { cycle_of_many(state, Locates::kOutlines); }
BENCHMARK(CycleOfManyOnTheRoad)->Arg(25)->Arg(1000)->ArgName("objects")->Unit(benchmark::kMicrosecond);

// One laser list of 25 observations that comes `scans` scans late.
void late_list(benchmark::State& state, const config::TrackerConfig& config) {
  const auto lists = static_cast<std::uint32_t>(state.range(0));
  std::unique_ptr<strategies::Strategy> strategy;
  std::uint32_t k = kCycles;
  std::int64_t allocations = 0;
  for (auto _ : state) {
    state.PauseTiming();
    if (k + 1 >= kCycles) {
      strategy = scene().start(strategies::StrategyKind::kAdva, kWarm, config);
      k = kWarm;
    }
    // Laser and camera in turn: everything younger than the laser's list goes in before it.
    const std::uint32_t late = k;
    for (std::uint32_t i = 0; i < lists; ++i) {
      if (i % 2 == 0)
        strategy->accept(scene().camera[late + i / 2].view());
      else
        strategy->accept(scene().laser[late + i / 2 + 1].view());
    }
    const GlobalTime now = scene().laser[late].measured + Duration::milliseconds(1000);
    strategy->fuse(now);
    const std::int64_t before_all = support::allocations();
    state.ResumeTiming();
    strategy->accept(scene().laser[late].view());
    strategy->fuse(now);
    state.PauseTiming();
    allocations += support::allocations() - before_all;
    if (strategy->last_fused()[0].disposition != strategies::Disposition::kFusedLate)
      state.SkipWithError("was not late");
    k = late + lists / 2 + 2;
    if (k + lists >= kCycles) k = kCycles;
    state.ResumeTiming();
  }
  report_allocations(state, allocations);
}
void LateList(benchmark::State& state) { late_list(state, {}); }
BENCHMARK(LateList)->Arg(1)->Arg(2)->Arg(8)->ArgName("lists_late")->Unit(benchmark::kMicrosecond);

// The same, by the methods that reach so far.
void LateListBy(benchmark::State& state) {
  config::TrackerConfig config;
  config.late = oosm::kKinds[static_cast<std::size_t>(state.range(1))].kind;
  state.SetLabel(std::string(oosm::name_of(config.late)));
  late_list(state, config);
}
BENCHMARK(LateListBy)
    ->ArgsProduct({{1, 2, 8}, benchmark::CreateDenseRange(1, 5, 1)})
    ->ArgNames({"lists_late", "late"})
    ->Unit(benchmark::kMicrosecond);

void Image(benchmark::State& state) {
  const auto strategy = scene().start(strategies::StrategyKind::kAdva, kWarm);
  std::vector<tracks::TrackView> image;
  image.reserve(64);
  const std::int64_t before_all = support::allocations();
  for (auto _ : state) {
    strategy->image(strategy->newest_measured() + Duration::milliseconds(100), image);
    benchmark::DoNotOptimize(image.data());
  }
  report_allocations(state, support::allocations() - before_all);
}
BENCHMARK(Image)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ttf::fusion

BENCHMARK_MAIN();
