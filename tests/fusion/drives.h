// Drives in milliseconds for the strategies' tests: arrivals, and when each list was fused.
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

// The name of a test that runs for every strategy.
inline std::string name_of_strategy(const testing::TestParamInfo<strategies::StrategyKind>& kind) {
  std::string name(name_of(kind.param));
  name.front() = static_cast<char>(name.front() - 'a' + 'A');
  return name;
}

// A sensor's timing in the schedule: measurements at unknown instants, or every `period_ms` from `first_ms`.
strategies::SensorTiming free_running(std::uint8_t sensor, std::int64_t worst_ms);
strategies::SensorTiming scheduled(std::uint8_t sensor, std::int64_t worst_ms, std::int64_t first_ms,
                                   std::int64_t period_ms);

// A laser and a camera on a schedule. The laser measures every 80 ms from 0 and takes 60 ms at worst. The
// camera measures every 40 ms from 20 and takes 35 ms at worst.
std::vector<strategies::SensorTiming> laser_and_camera();

struct Arrival {
  std::int64_t ms = 0;
  OwnedList list;
};
// Sorts by arrival; lists that arrive together keep their order.
void sort_by_arrival(std::vector<Arrival>& arrivals);

// Draws lists of laser_and_camera() with delays up to the worst, so that many arrive out of order. The drive
// has `laser_scans` lists of the laser and twice as many of the camera.
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

// Fuses every 10 ms from 0 to `until`. Returns all reports except those of held lists.
std::vector<Fused> run(strategies::Strategy& strategy, std::vector<Arrival> arrivals, std::int64_t until);

// Lists that the last fusion instant left waiting.
std::size_t held(const strategies::Strategy& strategy);

}  // namespace ttf::fusion
