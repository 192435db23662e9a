// Rows as a recording would have them, for tests of the replay.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/random.h"
#include "recording/replay/recorded_lists.h"
#include "recording/rows/observation_rows.h"

namespace ttf::recording::replay {

inline recording::rows::ObservationRow position_row(const std::string& sensor, std::int64_t time_ms,
                                                    std::int64_t arrival_ms, double x, double y) {
  recording::rows::ObservationRow row;
  row.sensor = sensor;
  row.time_ns = time_ms * 1'000'000;
  row.arrival_ns = arrival_ms * 1'000'000;
  row.z = {x, y, 0.0};
  return row;
}

// Two cars, one after the other on a lane, seen by a camera every 50 ms and a radar every 70 ms for
// `seconds`. Every list arrives as it is measured.
inline std::vector<recording::rows::ObservationRow> two_cars(int seconds) {
  std::vector<recording::rows::ObservationRow> rows;
  RandomStream noise({.seed = 5, .purpose = Purpose::kTest});
  for (std::int64_t ms = 0; ms < seconds * 1000; ms += 10)
    for (const bool radar : {false, true}) {
      if (ms % (radar ? 70 : 50) != 0) continue;
      for (const double start : {10.0, 40.0}) {
        const double x = start + 8.0 * static_cast<double>(ms) * 1e-3, y = 3.0;
        recording::rows::ObservationRow row =
            position_row(radar ? "radar" : "camera", ms, ms, x + 0.3 * noise.normal(), y + 0.3 * noise.normal());
        if (radar) {
          const double range = std::hypot(x, y);
          row.kind = recording::rows::ObservationRow::Kind::kRangeBearingRate;
          row.z = {range + 0.3 * noise.normal(), std::atan2(y, x) + 0.01 * noise.normal(),
                   8.0 * x / range + 0.2 * noise.normal()};
        }
        rows.push_back(row);
      }
    }
  return rows;
}

// For sensors with default noise.
inline RecordedLists recorded_lists_of_rows(const std::vector<recording::rows::ObservationRow>& rows,
                                            ReplayConfig& config) {
  list_sensors(config, rows, {}, "o.csv");
  Findings findings;
  RecordedLists arrivals = recorded_lists_of(rows, config, "o.csv", findings);
  findings.throw_if_any();
  return arrivals;
}

}  // namespace ttf::recording::replay
