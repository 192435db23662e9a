// The sensors of a scenario, by the names that they have in the cluster file:
//
//   sensors:
//     laser: {range_sigma: 0.1}                      # every laser without an entry of its own
//     front_laser: {kind: laser, mounting: {x: 3.5}, range_bias: 0.2, preprocessing: {range_noise: 0.1},
//                   period: 80 ms, colour: green, marker: plus}
//   preprocessing:
//     laser: {range_noise: 0.1}                      # of every laser without its own
//
// A key that an entry omits has its documented default, whatever other entries say. The schedule says when a sensor
// measures. So `period` only repeats the schedule, and another one is refused.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "nodes/camera/ground_plane.h"
#include "nodes/camera/triangulation.h"
#include "nodes/laser/laser_preprocessor.h"
#include "nodes/radar/returns.h"
#include "nodes/sensing/odometry.h"
#include "recording/log/sensor_style.h"
#include "schedules/model/cluster.h"
#include "sim/world/camera.h"
#include "sim/world/laser.h"
#include "sim/world/mono_camera.h"
#include "sim/world/odometry.h"
#include "sim/world/radar.h"
#include "sim/world/weather.h"

namespace ttf::sim::drives {

struct Scenario;

// `Model` is the sensor as the world emulates it, `Preprocessing` what its host assumes of it.
template <class Model, class Preprocessing> struct SensorEntry {
  std::string name;
  Model model;
  std::optional<Preprocessing> preprocessing;  // absent: that of the kind
  std::optional<Duration> period;              // absent: the schedule's, whatever it is
  recording::log::SensorStyle style;
};

template <class Model, class Preprocessing> struct SensorsOfKind {
  using Entry = SensorEntry<Model, Preprocessing>;

  Entry usual;                  // for every sensor of the kind without an entry of its own
  Preprocessing preprocessing;  // for every sensor of the kind without its own
  std::vector<Entry> own;

  const Entry& of(std::string_view name) const {
    for (const Entry& entry : own)
      if (entry.name == name) return entry;
    return usual;
  }
  const Preprocessing& preprocessing_of(std::string_view name) const {
    const Entry& entry = of(name);
    return entry.preprocessing ? *entry.preprocessing : preprocessing;
  }
};

struct Sensors {
  SensorsOfKind<sim::world::LaserConfig, nodes::laser::LaserPreprocessingConfig> lasers;
  SensorsOfKind<sim::world::CameraConfig, nodes::camera::CameraCalibration> cameras;
  SensorsOfKind<sim::world::RadarConfig, nodes::radar::RadarPreprocessingConfig> radars;
  SensorsOfKind<sim::world::MonoCameraConfig, nodes::camera::MonoCalibration> mono_cameras;
  SensorsOfKind<sim::world::OdometryConfig, nodes::sensing::OdometryPreprocessingConfig> odometries;

  // Returns whether the sensor measures; odometry always does.
  bool enabled(const schedules::model::Sensor& sensor) const;
};

// Reads `sensors`, and into the result `preprocessing`.
Sensors load_sensors(YamlMap& yaml);
void load_preprocessing(YamlMap& yaml, Sensors& sensors);
// Changes all sensors as this weather does.
void meet(const sim::world::Weather& weather, Sensors& sensors);

// Checks that the cluster has every sensor with an entry of its own. Its kind and its period must be the same there,
// and no recording may play it. Throws InputError with every finding.
void check_sensors(const Scenario& scenario, const schedules::model::Cluster& cluster);

// Returns how pictures show the cluster's sensors, by SensorId. It ends with the last one that the scenario styles.
std::vector<recording::log::SensorStyle> sensor_styles(const Sensors& sensors,
                                                       const schedules::model::Cluster& cluster);

}  // namespace ttf::sim::drives
