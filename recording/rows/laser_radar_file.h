// Reads recorded measurements: text files from other people's sensors.
//
// Each broken line is one finding (file, line, column name, value, expected value). All findings are thrown at
// once as one InputError, as are an unreadable file and one without rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"
#include "recording/rows/scan_file.h"

namespace ttf::recording::rows {

// One sensor's observation at one instant. Position: x, y in metres. Range-bearing-rate: range in metres,
// bearing in radians (0 ahead, positive left), range rate in m/s (positive: going away). The sensor stands at
// the origin.
struct RecordedObservation {
  enum class Kind : std::uint8_t { kPosition = 1, kRangeBearingRate = 2 };
  std::string sensor;                   // "laser" or "radar"
  std::int64_t time_us_from_start = 0;  // since the file's first row
  Kind kind = Kind::kPosition;
  double x = 0, y = 0;                            // kPosition
  double range = 0, bearing = 0, range_rate = 0;  // kRangeBearingRate
  int line = 0;                                   // in the file; 0 if the row is not from a file
};

// The truth that the recording has for the same instant.
struct RecordedTruth {
  std::int64_t time_us_from_start = 0;
  double x = 0, y = 0, vx = 0, vy = 0, yaw = 0, yaw_rate = 0;
};

// observations[i] and truth[i] belong together. Rows are sorted by time. Those of one time stay in the order of the
// file.
struct RecordedInput {
  std::string name = "recording";  // the file's, for messages
  std::int64_t first_time_us = 0;  // the first row's own time stamp
  std::vector<RecordedObservation> observations;
  std::vector<RecordedTruth> truth;
};

// Tab-separated rows, times in microseconds:
//   L  px  py  t_us  gt_x  gt_y  gt_vx  gt_vy  gt_yaw  gt_yawrate
//   R  range  bearing  range_rate  t_us  gt_x  gt_y  gt_vx  gt_vy  gt_yaw  gt_yawrate
// Rows may have any order. A single stamp that leaps is a finding (recording/rows/leaping_stamps.h). With `findings`,
// each broken row is left out and has one finding. Only a file without any sound row throws then.
RecordedInput read_laser_radar(const std::string& path);
RecordedInput read_laser_radar(const std::string& path, Findings& findings);
RecordedInput parse_laser_radar(const std::string& text, const std::string& name);
RecordedInput parse_laser_radar(const std::string& text, const std::string& name, Findings& findings);

// Returns the format of a file. Its first kRecordingHead bytes decide, so they must have the first row or heading.
// Throws InputError if the format is unknown.
inline constexpr std::size_t kRecordingHead = 64 * 1024;
enum class RecordingFormat : std::uint8_t { kLog = 1, kLaserRadar = 2, kLidarScans = 3 };
RecordingFormat sniff_recording(const std::string& path);
RecordingFormat sniff_recording(std::string_view bytes, const std::string& name);

}  // namespace ttf::recording::rows
