#include "tests/fusion/drives.h"

#include <algorithm>
#include <ostream>

namespace ttf::fusion {

strategies::SensorTiming free_running(std::uint8_t sensor, std::int64_t worst_ms) {
  return {static_cast<SensorId>(sensor), strategies::Settling::after(Duration::milliseconds(worst_ms)), false, {}, {}};
}
strategies::SensorTiming scheduled(std::uint8_t sensor, std::int64_t worst_ms, std::int64_t first_ms,
                                   std::int64_t period_ms) {
  return {static_cast<SensorId>(sensor), strategies::Settling::after(Duration::milliseconds(worst_ms)), true,
          at_ms(first_ms), Duration::milliseconds(period_ms)};
}

std::vector<strategies::SensorTiming> laser_and_camera() { return {scheduled(0, 60, 0, 80), scheduled(1, 35, 20, 40)}; }

void sort_by_arrival(std::vector<Arrival>& arrivals) {
  std::stable_sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) { return a.ms < b.ms; });
}

std::vector<Arrival> drawn_drive(std::uint64_t seed, std::uint32_t laser_scans) {
  RandomStream stream({.seed = seed});
  const Lanes laser{.miss_probability = 0.05, .seed = seed},
      camera{.sigma = 0.4, .miss_probability = 0.1, .seed = seed + 1000};
  std::vector<Arrival> arrivals;
  for (std::uint32_t k = 0; k < laser_scans; ++k)
    arrivals.push_back({80 * k + stream.integer(30, 60), list_of(0, k, at_ms(80 * k), laser.see(at_ms(80 * k), k))});
  for (std::uint32_t k = 0; k < 2 * laser_scans; ++k)
    arrivals.push_back(
        {20 + 40 * k + stream.integer(5, 35), list_of(1, k, at_ms(20 + 40 * k), camera.see(at_ms(20 + 40 * k), k))});
  return arrivals;
}

std::ostream& operator<<(std::ostream& out, const Fused& f) {
  return out << "{" << f.ms << " ms: " << index_of(f.id.sensor) << "/" << f.id.sequence << " "
             << static_cast<int>(f.disposition) << "}";
}
Fused fused(std::int64_t ms, std::uint8_t sensor, std::uint32_t sequence, strategies::Disposition d) {
  return {ms, {static_cast<SensorId>(sensor), sequence}, d};
}

std::vector<Fused> run(strategies::Strategy& strategy, std::vector<Arrival> arrivals, std::int64_t until) {
  sort_by_arrival(arrivals);
  std::vector<Fused> out;
  std::size_t next = 0;
  for (std::int64_t now = 0; now <= until; now += 10) {
    for (; next < arrivals.size() && arrivals[next].ms <= now; ++next) strategy.accept(arrivals[next].list.view());
    strategy.fuse(at_ms(now));
    for (const strategies::FusedList& f : strategy.last_fused())
      if (f.disposition != strategies::Disposition::kHeld) out.push_back({now, f.id, f.disposition});
  }
  return out;
}

std::size_t held(const strategies::Strategy& strategy) {
  return static_cast<std::size_t>(
      std::count_if(strategy.last_fused().begin(), strategy.last_fused().end(),
                    [](const strategies::FusedList& f) { return f.disposition == strategies::Disposition::kHeld; }));
}

}  // namespace ttf::fusion
