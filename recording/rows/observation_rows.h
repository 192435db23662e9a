// Recorded observations in: one row per object that a sensor saw, as comma-separated text with a heading.
//
// The heading names the columns, in any order; an empty cell is one that is not given.
//
//   time *                       instant of the measurement [s], on any scale
//   arrival                      instant at which the list came to the fusion [s]; without it, that of the measurement
//   sensor *                     its name
//   x, y                         position [m], or
//   range, bearing, range_rate   distance [m], direction [rad] from x to y, and, where the sensor tells it, the
//                                change of the distance [m/s], positive going away; the sensor stands at the origin
//   cov_11, cov_12, cov_22, cov_13, cov_23, cov_33
//                                covariance of what was measured, in its order and units; off the diagonal, 0 unless
//                                given
//   heading, sigma_heading       axis of the object [rad], known up to half a turn
//   length, sigma_length, width, sigma_width       [m]
//   z, height                    of the box's centre, and its third side [m]
//   class, score                 what the object is taken for, and how much that counts (1 where it is not given)
//
// * in every row, and one of the two kinds of measurement. Columns that begin with gt_ (truth) are passed over; others
// that are not known are refused. Rows of one sensor at one time are one list. A sensor's rows are in the order of its
// measurements; what arrives when is the column arrival, in any order, and different sensors may stand in any order.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.h"
#include "recording/rows/laser_radar_file.h"

namespace ttf::recording::rows {

struct ObservationRow {
  enum class Kind : std::uint8_t { kPosition = 1, kRangeBearing = 2, kRangeBearingRate = 3 };
  int line = 0;  // in the file; 0 where it came from no such file
  std::int64_t time_ns = 0, arrival_ns = 0;
  std::string sensor;
  Kind kind = Kind::kPosition;
  std::array<double, 3> z{};                        // as many as the kind has
  std::optional<std::array<double, 6>> covariance;  // 11, 12, 22, 13, 23, 33; finite, not yet known to be one
  std::optional<double> heading, sigma_heading, length, sigma_length, width, sigma_width;
  std::optional<double> elevation, height;
  std::string class_name;  // empty: not told
  double score = 1.0;
};

constexpr int dimension_of(ObservationRow::Kind kind) {
  return kind == ObservationRow::Kind::kRangeBearingRate ? 3 : 2;
}

// The rows that are right, in the order of the file; one finding for every one that is not, which is left out. Throws
// InputError where the file cannot be read, its heading is wrong, or it has no row at all.
std::vector<ObservationRow> read_observation_rows(const std::string& path, Findings& findings);
std::vector<ObservationRow> parse_observation_rows(const std::string& text, const std::string& name,
                                                   Findings& findings);

// A recording of laser and radar as such rows, without its truth. Throws InputError that names `name` where a time or a
// range is beyond what such rows may have.
std::vector<ObservationRow> observation_rows_of(const RecordedInput& input, const std::string& name);

}  // namespace ttf::recording::rows
