#include "sim/drives/known_fields.h"

#include <optional>

#include "nodes/fusion/fusion_host.h"
#include "sim/drives/step_catalog.h"

namespace ttf::sim::drives {
namespace {

using fusion::sensors::Field;

// A sensor that is switched off reaches nothing.
Field with_blind(Field field, const sim::world::Device& device) {
  static_assert(Field::kMostBlind == sim::world::BlindSides::kMost);
  if (!device.enabled) field.max_range = 0.0;
  field.blind_sectors = device.blind.count;
  for (std::size_t i = 0; i < device.blind.count; ++i)
    field.blind[i] = {device.blind.sectors[i].from, device.blind.sectors[i].to};
  return field;
}

// A laser's beams end at the first object.
std::optional<Field> field_of(const Sensors& sensors, const schedules::model::Sensor& sensor) {
  switch (sensor.kind) {
    case schedules::model::SensorKind::kLaser: {
      const sim::world::LaserConfig& laser = sensors.lasers.of(sensor.name).model;
      return with_blind({.half_angle = laser.half_field_rad, .max_range = laser.max_range_m}, laser.device);
    }
    case schedules::model::SensorKind::kCamera: {
      const sim::world::CameraConfig& camera = sensors.cameras.of(sensor.name).model;
      return with_blind({.half_angle = camera.half_field_rad, .max_range = camera.max_range_m, .shadow = camera.shadow},
                        camera.device);
    }
    case schedules::model::SensorKind::kRadar: {
      const sim::world::RadarConfig& radar = sensors.radars.of(sensor.name).model;
      return with_blind({.half_angle = radar.half_field_rad, .max_range = radar.max_range_m, .shadow = radar.shadow},
                        radar.device);
    }
    case schedules::model::SensorKind::kMonoCamera: {
      const sim::world::MonoCameraConfig& camera = sensors.mono_cameras.of(sensor.name).model;
      return with_blind({.half_angle = sim::world::looked_at(camera), .max_range = camera.max_range_m}, camera.device);
    }
    case schedules::model::SensorKind::kOdometry: break;
  }
  return std::nullopt;
}

}  // namespace

fusion::config::TrackerConfig tracker_of(const Scenario& scenario, const schedules::model::Cluster& cluster) {
  fusion::config::TrackerConfig tracker = nodes::fusion::tracker_in(cluster, scenario.tracker, scenario.file);
  if (is_recorded(cluster)) return tracker;
  tracker.sensors.resize(cluster.sensors.size());
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s) {
    fusion::sensors::KnownSensor& known = tracker.sensors[s];
    const schedules::model::Sensor& sensor = cluster.sensors[s];
    if (!known.field || !scenario.sensors.enabled(sensor)) known.field = field_of(scenario.sensors, sensor);
    if (sensor.kind == schedules::model::SensorKind::kRadar && known.range_rate_span == Field::kUnbounded)
      known.range_rate_span = scenario.sensors.radars.of(sensor.name).model.rate_span_mps;
  }
  return tracker;
}

}  // namespace ttf::sim::drives
