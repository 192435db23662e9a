// Holds a recording against the schedule: which row each device sends at each of its measurements.
//
// A row belongs to the instant at which it was measured, so it is played there or not at all:
//   as scheduled     A row is played at the instant of the schedule that is within `tolerance` of its stamp. If it is
//                    near an instant, but not near enough, and no other row is there, the recording is refused.
//   at their stamps  A device that runs freely measures at the stamps of its rows, not with its phase and period. Rows
//                    nearer to each other than its period are refused: the cluster is proved for the period. A device
//                    that the schedule triggers plays as scheduled.
//   resampled        Each list is interpolated between the rows before and after its instant, in the measured values.
//                    The truth stays as recorded. The noise of a list is smaller than that of a row, down to
//                    sqrt(1/2) of it half way, and successive lists share rows. An object that turns is cut short by
//                    up to a T^2 / 8 (acceleration a, gap T). Between rows further apart than two periods the device
//                    is silent.
//
// All times count from the recording's time 0: its first row, which is the first measurement of the cluster's first
// sensor. Devices measure by their own clocks: a device that runs freely needs a stated drift, and a stated phase
// unless it measures at the rows' stamps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/strict_yaml.h"
#include "core/time.h"
#include "recording/rows/laser_radar_file.h"
#include "schedules/model/cluster.h"

namespace ttf::sensors::recorded {

enum class RowsArePlayed : std::uint8_t { kAsScheduled, kAtTheirStamps, kResampled };

struct RecordedPlaying {
  RowsArePlayed rows = RowsArePlayed::kAsScheduled;
  Duration tolerance = Duration::milliseconds(1);  // 3 cm at 30 m/s
};
// Reads the keys `rows` and `tolerance`.
RecordedPlaying load_recorded_playing(YamlMap& yaml);

struct PlayedRows {
  std::vector<std::optional<recording::rows::RecordedObservation>> at;  // by measurement; empty: the device is silent
  std::vector<Duration> times;     // their instants in true time, since the recording's time 0
  std::vector<Duration> instants;  // the same on a free device's clock, since the first cycle
  std::size_t rows = 0;            // number in the recording for this sensor
  std::size_t lists = 0;           // measurements with a row
  std::size_t between = 0;         // rows that no list was made of: between the instants,
  std::size_t beyond = 0;          // or after the drive's last one
  std::size_t silent = 0;          // measurements without a row, before the sensor's last row
};

// Returns the first measurement of a sensor, from the start of the first cycle; its phase if it runs freely.
Duration first_measurement(const schedules::model::Cluster& cluster, const schedules::model::Sensor& sensor);

// `until` is the drive's end. Throws InputError that names line and stamp of the first row that does not fit, with the
// instants of the schedule.
PlayedRows played_rows(const recording::rows::RecordedInput& input, const schedules::model::Cluster& cluster,
                       SensorId sensor, const RecordedPlaying& playing, Duration until);

}  // namespace ttf::sensors::recorded
