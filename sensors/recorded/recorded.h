// Recorded observations replace the sensor models; the rest of the cluster is the same.
//
// A `recorded_source` device sends at each measurement the row that was measured then (sensors/recorded/played_rows.h).
// The host's `recorded_preprocessing` adds the documented noise of the recording as the observation's covariance.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/strict_yaml.h"
#include "nodes/host/step.h"
#include "recording/rows/laser_radar_file.h"
#include "schedules/model/cluster.h"
#include "sensors/recorded/played_rows.h"
#include "sensors/scene.h"

namespace ttf::sensors::recorded {

// Returns whether the cluster takes its observations from a recording.
bool is_recorded(const schedules::model::Cluster& cluster);

// Standard deviations of a recorded sensor. The defaults are those of the laser and the radar of the public
// recording that the loader reads.
struct RecordedNoise {
  double position_m = 0.15;
  double range_m = 0.3;
  double bearing_rad = 0.03;
  double range_rate_mps = 0.3;
};

//   recorded:
//     position: 0.15                                # of every sensor
//     sensors: {front_laser: {position: 0.1}}       # other keys as above
struct RecordedNoises {
  struct OfSensor {
    std::string sensor;
    RecordedNoise noise;
    int line = 0;
  };
  RecordedNoise usual;
  std::vector<OfSensor> own;

  const RecordedNoise& of(std::string_view sensor) const;
};
// Reads the keys `position`, `range`, `bearing`, `range_rate` and `sensors`.
RecordedNoises load_recorded_noises(YamlMap& yaml);

// The recording's ground truth as the scene: cubic Hermite interpolation between its rows (position and velocity).
// Outside its first and last row the truth is unknown: the scene is empty, and measures skip these times.
class RecordedScene final : public Scene {
 public:
  // `start` is the true time of recorded time 0.
  RecordedScene(const recording::rows::RecordedInput& input, TrueTime start);
  void states_at(TrueTime at, std::vector<sim::world::ObjectState>& out) const override;
  std::size_t objects() const override { return 1; }

 private:
  std::vector<recording::rows::RecordedTruth> rows_;
  TrueTime start_;
};

// Port `raw`.
class RecordedSource final : public nodes::host::Step {
 public:
  // `start` is the true time of recorded time 0. A measurement plays the row of its own instant, the one nearest to it
  // within half a period: also after a restart, or after triggers that did not come. Without a row the device is silent.
  // Throws InputError if there is no row at all, or if rows and raw PDU have other signals.
  RecordedSource(const schedules::model::Cluster& cluster, const schedules::model::Task& task, SensorId sensor,
                 PlayedRows rows, TrueTime start);
  void run(nodes::host::StepContext& context) override;

 private:
  const recording::rows::RecordedObservation* row_at(TrueTime now);

  SensorId sensor_;
  PlayedRows rows_;
  TrueTime start_;
  Duration period_;
  std::optional<std::size_t> last_;  // the measurement that was played last
  std::vector<std::size_t> signals_;
};

// Ports: `raw` -> `objects`.
class RecordedPreprocessing final : public nodes::host::Step {
 public:
  RecordedPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                        const RecordedNoise& noise);
  void run(nodes::host::StepContext& context) override;

 private:
  SensorId sensor_;
  RecordedNoise noise_;
  std::vector<std::size_t> raw_;
  std::vector<std::size_t> signals_;
  bool radar_;
};

}  // namespace ttf::sensors::recorded
