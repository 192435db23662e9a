// Eight sensors at 25 Hz see 10 objects for 20 s, straight into a strategy, without a bus. The aim is 0.1 s for the
// whole drive (docs/fusion/tracker.md says what is reached). Any allocation after the start is an error.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "tests/bench/crowd.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion {
namespace {

constexpr std::uint8_t kSensors = 8;
constexpr std::uint32_t kPeriods = 500;
constexpr int kObjects = 10;

// Sensors of one kind, or those of a car: two lasers see ends, two cameras silhouettes, four radars range rates, too.
enum class Kinds : std::uint8_t { kCentres, kOfACar };
// Every list comes 20 ms after its instant. Or those of two sensors come after 45 ms, behind four younger ones.
enum class Delays : std::uint8_t { kEqual, kOvertaking };

struct Arrival {
  GlobalTime at{};
  OwnedList list;
};

Duration delay_of(std::uint8_t sensor, Delays delays) {
  return Duration::milliseconds(delays == Delays::kOvertaking && sensor % 4 == 0 ? 45 : 20);
}
bool is_radar(std::uint8_t sensor, Kinds kinds) { return kinds == Kinds::kOfACar && sensor >= 4; }

std::vector<sensors::Observation> silhouettes_by_radar(const Lanes& lanes, GlobalTime at, std::uint32_t index) {
  constexpr double kRange_m = 0.2, kBearing_rad = 0.005, kRate_mps = 0.1;
  RandomStream stream({.seed = lanes.seed, .purpose = Purpose::kTest, .entity = 79, .index = index});
  const Outlines outlines{lanes, sensors::SeenPoint::kSilhouette};
  std::vector<sensors::Observation> seen;
  for (int object = 0; object < lanes.objects; ++object) {
    const estimators::State car = lanes.truth(object, at);
    const linear::Vector<2> middle = outlines.middle_of(car);
    sensors::Observation z = radar(
        middle.norm() + kRange_m * stream.normal(), std::atan2(middle.y(), middle.x()) + kBearing_rad * stream.normal(),
        middle.dot(car.segment<2>(2)) / middle.norm() + kRate_mps * stream.normal(), kRange_m, kBearing_rad, kRate_mps);
    z.seen = sensors::SeenPoint::kSilhouette;
    z.returns = 3;
    seen.push_back(z);
  }
  return seen;
}

std::vector<sensors::Observation> seen_by(std::uint8_t sensor, Kinds kinds, GlobalTime at, std::uint32_t index) {
  const Lanes lanes{.objects = kObjects, .sigma = 0.2, .seed = std::uint64_t{1} + sensor};
  if (is_radar(sensor, kinds)) return silhouettes_by_radar(lanes, at, index);
  if (kinds == Kinds::kOfACar)
    return Outlines{lanes, sensor < 2 ? sensors::SeenPoint::kEnd : sensors::SeenPoint::kSilhouette}.see(at, index);
  return lanes.see(at, index);
}

// The sensors take turns, 5 ms one after another. Lists are in the order of arrival.
struct EightSensors {
  std::vector<Arrival> arrivals;
  std::vector<strategies::SensorTiming> timings;

  EightSensors(Kinds kinds, Delays delays) {
    const Duration period = Duration::milliseconds(40);
    for (std::uint8_t sensor = 0; sensor < kSensors; ++sensor) {
      timings.push_back({SensorId{sensor}, strategies::Settling::after(delay_of(sensor, delays)), true,
                         at_ms(5 * sensor), period, is_radar(sensor, kinds)});
      for (std::uint32_t k = 0; k < kPeriods; ++k) {
        const GlobalTime measured = at_ms(40 * k + 5 * sensor);
        arrivals.push_back(
            {measured + delay_of(sensor, delays), list_of(sensor, k, measured, seen_by(sensor, kinds, measured, k))});
      }
    }
    std::stable_sort(arrivals.begin(), arrivals.end(),
                     [](const Arrival& one, const Arrival& other) { return one.at < other.at; });
  }
};

// Fuses every 10 ms, as the shipped clusters do, and gives an image every 40 ms.
void EightSensorsDrive(benchmark::State& state) {
  const auto kind = static_cast<strategies::StrategyKind>(state.range(0));
  const EightSensors drive(static_cast<Kinds>(state.range(1)), static_cast<Delays>(state.range(2)));
  config::TrackerConfig config = config_of(static_cast<config::MotionModel>(state.range(3)));
  state.SetLabel(std::string(strategies::name_of(kind)));
  std::vector<tracks::TrackView> image;
  image.reserve(static_cast<std::size_t>(config.max_objects));
  std::int64_t allocations = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const auto strategy = make_strategy(kind, config, drive.timings);
    state.ResumeTiming();
    const std::int64_t before = support::allocations();
    auto next = drive.arrivals.begin();
    for (std::uint32_t ms = 0; ms < 40 * kPeriods; ms += 10) {
      for (; next != drive.arrivals.end() && next->at <= at_ms(ms); ++next) strategy->accept(next->list.view());
      strategy->fuse(at_ms(ms));
      if (ms % 40 == 0) strategy->image(at_ms(ms + 20), image);
    }
    allocations += support::allocations() - before;
  }
  if (image.size() != kObjects) state.SkipWithError("not all objects are tracked");
  state.counters["allocations"] = static_cast<double>(allocations);
  if (allocations != 0) state.SkipWithError("the drive allocates");
  state.counters["x real time"] = benchmark::Counter(20.0, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(EightSensorsDrive)
    ->ArgsProduct({benchmark::CreateDenseRange(0, strategies::kStrategyCount - 1, 1), {0, 1}, {0, 1}, {0, 3}})
    ->ArgNames({"strategy", "kinds", "delays", "motion"})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ttf::fusion
