// Reads recorded scans of a laser scanner: one row per return, as comma-separated text.
//
// With a heading its columns may have any order; without one they are frame, azimuth_rad, range_m, intensity.
//
//   frame or time                whole number of the scan, or its instant [s]. Rows of one scan share it
//   azimuth_rad and range_m      direction of the return [rad], 0 ahead, positive left, and its distance [m], or
//   x and y                      its place in the scanner's axes [m]
//   intensity                    optional, in any unit
//
// Rows may have any order: scans are sorted by frame or time, and the rows of one scan keep the order of the file. A
// single stamp that leaps is a finding (recording/rows/leaping_stamps.h).
//
// Each broken line is one finding (file, line, column, value, expected value). But if many azimuths are beyond a whole
// turn, they are in degrees: that is one finding in all.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.h"

namespace ttf::recording::rows {

// One turn of a laser scanner: returns in order of the file, azimuth 0 ahead, positive left.
struct RecordedReturn {
  double azimuth_rad = 0, range_m = 0, intensity = 0;
};
struct RecordedScan {
  std::int64_t frame = 0;               // with a column time, the place of the scan by time, from 0
  std::optional<std::int64_t> time_ns;  // with a column time
  std::vector<RecordedReturn> returns;
};

// All throw InputError with all findings at once; so they do for an unreadable file and one without rows. With
// `findings`, each broken row is left out and has one finding.
std::vector<RecordedScan> read_lidar_scans(const std::string& path);
std::vector<RecordedScan> read_lidar_scans(const std::string& path, Findings& findings);
std::vector<RecordedScan> parse_lidar_scans(const std::string& text, const std::string& name);
std::vector<RecordedScan> parse_lidar_scans(const std::string& text, const std::string& name, Findings& findings);

}  // namespace ttf::recording::rows
