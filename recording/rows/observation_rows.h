// Reads recorded observations: one row per object that a sensor saw, as comma-separated text with a heading.
//
// The heading names the columns, in any order; an empty cell has no value.
//
//   time *                       instant of the measurement [s], on any scale
//   arrival                      arrival of the list at the fusion [s]; default: the instant of the measurement
//   sensor *                     its name
//   x, y                         position [m], or
//   range, bearing, range_rate   distance [m], direction [rad] from x to y, and, if the sensor has it, the rate of
//                                the distance [m/s], positive going away; the sensor stands at the origin
//   cov_11, cov_12, cov_22, cov_13, cov_23, cov_33
//                                covariance of the measured values, in their order and units; 0 off the diagonal
//                                unless given
//   heading, sigma_heading       axis of the object [rad], known up to half a turn
//   length, sigma_length, width, sigma_width       [m]
//   z, height                    of the box: its centre's, and its third side [m]
//   class, score                 class of the object, and the weight of that (default 1)
//   gt_x, gt_y                   true position of the object at the instant of the measurement [m]; both columns or none
//   gt_vx, gt_vy                 its true velocity [m/s]
//   gt_object                    its name (default: one object without a name)
//
// * in every row, with one of the two kinds of measurement. Other columns that begin with gt_ are ignored; other
//   unknown columns are refused. Rows of one sensor at one time are one list. Rows may have any order. A
//   single stamp that leaps is a finding (recording/rows/leaping_stamps.h).
//
// The whole file is read: rows in any order have no other bound.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.h"
#include "recording/rows/laser_radar_file.h"

namespace ttf::recording::rows {

// The true state of the object that a row is of.
struct RowTruth {
  std::string object;
  double x = 0.0, y = 0.0;
  std::optional<std::array<double, 2>> velocity;
};

struct ObservationRow {
  enum class Kind : std::uint8_t { kPosition = 1, kRangeBearing = 2, kRangeBearingRate = 3 };
  int line = 0;  // in the file; 0 if the row is not from a file
  std::int64_t time_ns = 0, arrival_ns = 0;
  std::string sensor;
  Kind kind = Kind::kPosition;
  std::array<double, 3> z{};                        // as many as the kind has
  std::optional<std::array<double, 6>> covariance;  // 11, 12, 22, 13, 23, 33; finite, not yet checked
  std::optional<double> heading, sigma_heading, length, sigma_length, width, sigma_width;
  std::optional<double> elevation, height;
  std::string class_name;  // empty: not given
  double score = 1.0;
  std::optional<RowTruth> truth;
};

constexpr int dimension_of(ObservationRow::Kind kind) {
  return kind == ObservationRow::Kind::kRangeBearingRate ? 3 : 2;
}

// Returns the valid rows, in the order of the file; each invalid one is left out and has one finding. Throws
// InputError if the file is unreadable, has a wrong heading, or has no row at all.
std::vector<ObservationRow> read_observation_rows(const std::string& path, Findings& findings);
std::vector<ObservationRow> parse_observation_rows(const std::string& text, const std::string& name,
                                                   Findings& findings);

// Converts a recording of laser and radar into such rows, with its truth. Throws InputError that names
// `name` if a time or a range is out of bounds for such rows.
std::vector<ObservationRow> observation_rows_of(const RecordedInput& input, const std::string& name);

}  // namespace ttf::recording::rows
