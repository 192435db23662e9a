// Reads the motion of the sensors' vehicle: one row an instant, as comma-separated text with a heading.
//
// The heading names the columns, in any order:
//   time                 instant [s], on the scale of the observations
//   x, y, heading        pose over ground [m], [rad] from the ground's x axis to the vehicle's, or
//   speed, yaw_rate      of the vehicle, along its x axis [m/s], [rad/s]
//
// Each row has all columns. Rows may have any order, and no two the same time.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/errors.h"

namespace ttf::recording::rows {

struct EgoRow {
  int line = 0;
  std::int64_t time_ns = 0;
  std::array<double, 3> value{};  // x, y, heading; or speed and yaw rate
};

struct EgoRows {
  bool poses = false;
  std::vector<EgoRow> rows;  // in the order of time; at least one
};

// Throws InputError if the file is unreadable, has a wrong heading, or has a wrong row.
EgoRows read_ego_rows(const std::string& path);
EgoRows parse_ego_rows(const std::string& text, const std::string& name);

}  // namespace ttf::recording::rows
