// Drives in milliseconds for the tests of the strategies: what arrives when, and what was fused when.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "fusion/strategies/strategy.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion {

// The name of a test that is run for every strategy.
inline std::string name_of_strategy(const testing::TestParamInfo<strategies::StrategyKind>& kind) {
  std::string name(name_of(kind.param));
  name.front() = static_cast<char>(name.front() - 'a' + 'A');
  return name;
}

// What the schedule promises of a sensor: measurements at unknown instants, or every `period_ms` from
// `first_ms`.
strategies::SensorTiming free_running(std::uint8_t sensor, std::int64_t worst_ms);
strategies::SensorTiming scheduled(std::uint8_t sensor, std::int64_t worst_ms, std::int64_t first_ms,
                                   std::int64_t period_ms);

// Laser and camera, both on a schedule: from 0 every 80 ms, there after 60 ms at worst; from 20 every 40 ms,
// after 35.
std::vector<strategies::SensorTiming> laser_and_camera();

struct Arrival {
  std::int64_t ms = 0;
  OwnedList list;
};
// In the order of their arrival; what arrives together stays as it is.
void sort_by_arrival(std::vector<Arrival>& arrivals);

// Lists of laser_and_camera() with delays up to their worst, so that many arrive out of order: `laser_scans`
// of the laser, twice as many of the camera.
std::vector<Arrival> drawn_drive(std::uint64_t seed, std::uint32_t laser_scans);

struct Fused {
  std::int64_t ms = 0;
  MeasurementId id;
  strategies::Disposition disposition = strategies::Disposition::kFused;
  bool operator==(const Fused&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Fused& f);
Fused fused(std::int64_t ms, std::uint8_t sensor, std::uint32_t sequence,
            strategies::Disposition d = strategies::Disposition::kFused);

// Fusion every 10 ms from 0 to `until`; what was reported, held lists left out.
std::vector<Fused> run(strategies::Strategy& strategy, std::vector<Arrival> arrivals, std::int64_t until);

// Lists that the last fusion instant left waiting.
std::size_t held(const strategies::Strategy& strategy);

}  // namespace ttf::fusion
