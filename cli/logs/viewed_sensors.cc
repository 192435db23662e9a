#include "cli/logs/viewed_sensors.h"

#include <cstddef>
#include <optional>

#include "cli/logs/attached.h"
#include "report/drawing/names.h"
#include "sensors/kinds/sensors.h"
#include "sensors/recorded/recorded.h"

namespace ttf::cli::logs {
namespace {

using recording::scene::Pose;
using recording::scene::ViewedField;
using recording::scene::ViewedSensor;

// A sensor that the world emulates, as it is. The knowledge of the fusion may differ.
template <class Model> void place_emulated(const Model& model, ViewedSensor& sensor) {
  sensor.mounting = Pose{model.device.placement.x, model.device.placement.y, model.device.placement.heading};
  if constexpr (requires { model.half_field_rad; })
    sensor.field = ViewedField{model.half_field_rad, 0.0, model.max_range_m};
}

// A recorded sensor, as the fusion has it.
void place_known(const fusion::sensors::KnownSensor& known, ViewedSensor& sensor) {
  sensor.mounting = Pose{known.mounting.position.x(), known.mounting.position.y(), known.mounting.yaw};
  if (known.field && known.field->max_range < fusion::sensors::Field::kUnbounded)
    sensor.field = ViewedField{known.field->half_angle, known.field->min_range, known.field->max_range};
}

void place_in(const Attached& attached, std::size_t index, ViewedSensor& sensor) {
  if (!attached.scenario || !attached.cluster || index >= attached.cluster->sensors.size()) return;
  const schedules::model::Sensor& of = attached.cluster->sensors[index];
  sensor.odometry = !schedules::model::row_of(of.kind).observes;
  if (!sensor.odometry && !sensors::recorded::is_recorded(*attached.cluster))
    return sensors::kinds::Sensors::of_kind(attached.scenario->sensors, of.kind,
                                            [&](const auto& kind) { place_emulated(kind.of(of.name).model, sensor); });
  for (const fusion::sensors::KnownSensor& known : attached.scenario->tracker.sensors)
    if (known.name == of.name) place_known(known, sensor);
}

}  // namespace

std::vector<ViewedSensor> viewed_sensors(const recording::merge::MergedLogs& drive,
                                         std::vector<std::string>& warnings) {
  const report::drawing::Names names = report::drawing::names_of(drive.manifest());
  const Attached attached = attached_to(drive, "the sensors' places are left out", warnings);
  std::vector<ViewedSensor> sensors(names.sensors.size());
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    const auto id = static_cast<SensorId>(s);
    sensors[s].name = names.sensor(id);
    sensors[s].colour = report::drawing::sensor_colour(names, id);
    place_in(attached, s, sensors[s]);
  }
  return sensors;
}

}  // namespace ttf::cli::logs
