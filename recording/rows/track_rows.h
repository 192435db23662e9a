// Writes tracks: one row per track and instant, as comma-separated text.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ttf::recording::rows {

struct TrackRow {
  std::int64_t time_ns = 0;   // instant of the state
  std::int64_t known_ns = 0;  // the fusion instant that gave it
  int track = 0;
  double x = 0, y = 0, vx = 0, vy = 0;  // [m], [m/s]
  // Upper triangle of the covariance of (x, y, vx, vy), by rows.
  std::array<double, 10> covariance{};
  double heading = 0, sigma_heading = 0;  // [rad]
  std::optional<double> length, width;    // [m], absent if not measured
  std::optional<double> z, height;        // [m], of the newest observation with them
  std::string class_name;                 // empty: no class was given
  double class_share = 0;                 // this class' part of all scores
  bool coasting = false;                  // not observed of late: predicted only
};

// Both with their line end. Times are exact decimals in seconds. Positions, velocities, angles and sizes have
// six decimals, the covariance nine significant digits; unknown values are empty.
std::string_view track_heading();
std::string track_line(const TrackRow& row);

}  // namespace ttf::recording::rows
