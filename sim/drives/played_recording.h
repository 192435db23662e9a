// The rows of a recording that a drive plays, and those that it leaves over.
#pragma once

#include <string>
#include <vector>

#include "core/time.h"
#include "recording/rows/laser_radar_file.h"
#include "schedules/model/cluster.h"
#include "sensors/recorded/played_rows.h"
#include "sim/drives/scenario.h"

namespace ttf::sim::drives {

// Returns the sensors whose devices play a recording.
std::vector<SensorId> played_sensors(const schedules::model::Cluster& cluster);

// Returns the rows of a sensor by measurement. Throws InputError if a row does not fit (sensors/recorded/played_rows.h).
sensors::recorded::PlayedRows rows_of(const Scenario& scenario, const schedules::model::Cluster& cluster,
                                      const recording::rows::RecordedInput& recorded, SensorId sensor);

// Returns the cluster with the instants of the devices that measure at the stamps of their rows.
schedules::model::Cluster cluster_that_plays(const Scenario& scenario, const schedules::model::Cluster& cluster,
                                             const recording::rows::RecordedInput& recorded);

// A drive's use of its recording.
struct RecordingUse {
  struct OfSensor {
    std::string sensor;
    sensors::recorded::PlayedRows rows;
  };
  sensors::recorded::RowsArePlayed played{};
  std::vector<OfSensor> sensors;
  TrueTime end{};       // the last row
  Duration ends_after;  // from the drive's start
  Duration duration;    // the length of the drive
  bool ends_early() const { return ends_after < duration; }
};
// Throws InputError if a row does not fit, or a sensor has none within the drive.
RecordingUse recording_use(const Scenario& scenario, const schedules::model::Cluster& cluster,
                           const recording::rows::RecordedInput& recorded);
// Returns the use in sentences, one a line.
std::string recording_text(const RecordingUse& use);

}  // namespace ttf::sim::drives
