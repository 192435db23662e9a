#include "sensors/kinds/sensors.h"

namespace ttf::sensors::kinds {
namespace {

std::string_view name_of(const schedules::model::Cluster& cluster, SensorId sensor) {
  return sensor == kNoSensor ? std::string_view() : cluster.sensor(sensor).name;
}

}  // namespace

Sensors::Sensors() = default;
Sensors::Sensors(const Sensors&) = default;
Sensors::Sensors(Sensors&&) noexcept = default;
Sensors& Sensors::operator=(const Sensors&) = default;
Sensors& Sensors::operator=(Sensors&&) noexcept = default;
Sensors::~Sensors() = default;

const Device& Sensors::device_of(const schedules::model::Sensor& sensor) const {
  return of_kind(*this, sensor.kind,
                 [&](const auto& kind) -> const Device& { return kind.of(sensor.name).model.device; });
}

std::optional<fusion::sensors::Field> Sensors::field_of(const schedules::model::Sensor& sensor) const {
  return of_kind(*this, sensor.kind, [&]<class Kind>(const SensorsOfKind<Kind>& kind) {
    return Kind::field_of(kind.of(sensor.name).model);
  });
}

std::optional<double> Sensors::rate_span(const schedules::model::Sensor& sensor) const {
  return of_kind(*this, sensor.kind, [&]<class Kind>(const SensorsOfKind<Kind>& kind) {
    return Kind::rate_span(kind.of(sensor.name).model);
  });
}

std::optional<fusion::sensors::Resolution> Sensors::resolution(const schedules::model::Sensor& sensor) const {
  return of_kind(*this, sensor.kind, [&]<class Kind>(const SensorsOfKind<Kind>& kind) {
    return Kind::resolution(kind.preprocessing_of(sensor.name));
  });
}

std::vector<SensorView> views_of(const Sensors& sensors, const schedules::model::Cluster& cluster) {
  std::vector<SensorView> views;
  for (const schedules::model::Sensor& sensor : cluster.sensors)
    if (const auto field = sensors.field_of(sensor)) views.push_back({sensors.device_of(sensor).placement, *field});
  return views;
}

void apply_weather(const sim::world::Weather& weather, Sensors& sensors) {
  Sensors::each(sensors, [&]<class Kind>(SensorsOfKind<Kind>& kind) {
    kind.usual.model = Kind::in_weather(kind.usual.model, weather);
    for (auto& entry : kind.own) entry.model = Kind::in_weather(entry.model, weather);
  });
}

std::vector<recording::log::SensorStyle> sensor_styles(const Sensors& sensors,
                                                       const schedules::model::Cluster& cluster) {
  std::vector<recording::log::SensorStyle> styles;
  for (const schedules::model::Sensor& sensor : cluster.sensors)
    styles.push_back(
        Sensors::of_kind(sensors, sensor.kind, [&](const auto& kind) { return kind.of(sensor.name).style; }));
  while (!styles.empty() && styles.back() == recording::log::SensorStyle{}) styles.pop_back();
  return styles;
}

std::shared_ptr<nodes::host::Step> make_step(const Sensors& sensors, const EmulatorConfig& config) {
  const schedules::model::Cluster& cluster = *config.cluster;
  const schedules::model::Task& task = *config.task;
  std::shared_ptr<nodes::host::Step> made;
  Sensors::each(sensors, [&]<class Kind>(const SensorsOfKind<Kind>& kind) {
    for (const SensorSteps& steps : Kind::kSteps)
      if (task.step == steps.emulator.step)
        made = std::make_shared<typename Kind::EmulatorStep>(config, kind.of(name_of(cluster, config.sensor)).model);
      else if (task.step == steps.preprocessing.step)
        made = std::make_shared<typename Kind::PreprocessingStep>(
            cluster, task, kind.preprocessing_of(name_of(cluster, layout_read(cluster, task, "raw").sensor)));
  });
  return made;
}

}  // namespace ttf::sensors::kinds
