#include "drives/known_fields.h"

#include <optional>

#include "drives/step_catalog.h"
#include "nodes/fusion/fusion_host.h"

namespace ttf::drives {
namespace {

using fusion::sensors::Field;

// A laser's beams end at the first object.
std::optional<Field> field_of(const Sensors& sensors, const schedules::model::Sensor& sensor) {
  switch (sensor.kind) {
    case schedules::model::SensorKind::kLaser: {
      const sim::world::LaserConfig& laser = sensors.lasers.of(sensor.name).model;
      return Field{.half_angle = laser.half_field_rad, .max_range = laser.max_range_m};
    }
    case schedules::model::SensorKind::kCamera: {
      const sim::world::CameraConfig& camera = sensors.cameras.of(sensor.name).model;
      return Field{.half_angle = camera.half_field_rad, .max_range = camera.max_range_m, .shadow = camera.shadow};
    }
    case schedules::model::SensorKind::kRadar:
    case schedules::model::SensorKind::kMonoCamera:
    case schedules::model::SensorKind::kOdometry: break;
  }
  return std::nullopt;
}

}  // namespace

fusion::config::TrackerConfig tracker_of(const Scenario& scenario, const schedules::model::Cluster& cluster) {
  fusion::config::TrackerConfig tracker = nodes::fusion::tracker_in(cluster, scenario.tracker, scenario.file);
  if (is_recorded(cluster)) return tracker;
  tracker.sensors.resize(cluster.sensors.size());
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s)
    if (fusion::sensors::KnownSensor& known = tracker.sensors[s]; !known.field)
      known.field = field_of(scenario.sensors, cluster.sensors[s]);
  return tracker;
}

}  // namespace ttf::drives
