#include "sim/drives/sensors.h"

#include <fmt/format.h>

#include <array>

#include "core/counted.h"
#include "core/nearest.h"
#include "sim/drives/scenario.h"
#include "sim/drives/step_catalog.h"

namespace ttf::sim::drives {
namespace {

using schedules::model::SensorKind;

// The kinds that the world can emulate. A kind's name is also that of its usual entry.
const Choices<SensorKind> kKinds{{"laser", SensorKind::kLaser},
                                 {"camera", SensorKind::kCamera},
                                 {"radar", SensorKind::kRadar},
                                 {"mono_camera", SensorKind::kMonoCamera},
                                 {"odometry", SensorKind::kOdometry}};

// They are also the names of entries that need no kind.
std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const auto& [name, kind] : kKinds) names.emplace_back(name);
  return names;
}

std::string_view name_of(SensorKind kind) {
  switch (kind) {
    case SensorKind::kLaser: return "laser";
    case SensorKind::kCamera: return "camera";
    case SensorKind::kRadar: return "radar";
    case SensorKind::kMonoCamera: return "mono_camera";
    case SensorKind::kOdometry: break;
  }
  return "odometry";
}

void load(YamlMap& yaml, sim::world::LaserConfig& laser) { laser = sim::world::load_laser(yaml); }
void load(YamlMap& yaml, sim::world::CameraConfig& camera) { camera = sim::world::load_camera(yaml); }
void load(YamlMap& yaml, sim::world::OdometryConfig& odometry) { odometry = sim::world::load_odometry(yaml); }
void load(YamlMap& yaml, nodes::laser::LaserPreprocessingConfig& preprocessing) {
  preprocessing = nodes::laser::load_laser_preprocessing(yaml);
}
void load(YamlMap& yaml, nodes::camera::CameraCalibration& preprocessing) {
  preprocessing = nodes::camera::load_camera_calibration(yaml);
}
void load(YamlMap& yaml, nodes::sensing::OdometryPreprocessingConfig& preprocessing) {
  preprocessing = nodes::sensing::load_odometry_preprocessing(yaml);
}

void load(YamlMap& yaml, sim::world::RadarConfig& radar) { radar = sim::world::load_radar(yaml); }
void load(YamlMap& yaml, sim::world::MonoCameraConfig& camera) { camera = sim::world::load_mono_camera(yaml); }
void load(YamlMap& yaml, nodes::camera::MonoCalibration& preprocessing) {
  preprocessing = nodes::camera::load_mono_calibration(yaml);
}
void load(YamlMap& yaml, nodes::radar::RadarPreprocessingConfig& preprocessing) {
  preprocessing = nodes::radar::load_radar_preprocessing(yaml);
}

template <std::size_t kCount>
std::string word(YamlMap& yaml, std::string_view key, const std::array<std::string_view, kCount>& words) {
  if (!yaml.has(key)) return "";
  Choices<std::string_view> choices;
  for (const std::string_view one : words) choices.emplace_back(one, one);
  return std::string(yaml.choice(key, choices));
}

// Reads all of an entry but its kind.
template <class Model, class Preprocessing>
SensorEntry<Model, Preprocessing> load_entry(YamlMap& yaml, std::string name) {
  SensorEntry<Model, Preprocessing> entry;
  entry.name = std::move(name);
  load(yaml, entry.model);
  if (auto preprocessing = yaml.map_if("preprocessing")) {
    load(*preprocessing, entry.preprocessing.emplace());
    preprocessing->finish();
  }
  if (yaml.has("period"))
    entry.period = yaml.duration("period", {Duration::milliseconds(1), Duration::milliseconds(10'000)});
  entry.style.colour = word(yaml, "colour", recording::log::kSensorColours);
  entry.style.marker = word(yaml, "marker", recording::log::kSensorMarkers);
  yaml.finish();
  return entry;
}

template <class Model, class Preprocessing>
void load_usual(YamlMap& yaml, SensorKind kind, SensorsOfKind<Model, Preprocessing>& sensors) {
  const std::string_view name = name_of(kind);
  if (auto entry = yaml.map_if(name)) {
    entry->choice_or<SensorKind>("kind", kind, {{name, kind}});
    sensors.usual = load_entry<Model, Preprocessing>(*entry, std::string(name));
  }
}

template <class Model, class Preprocessing>
void load_own(YamlMap& yaml, SensorKind kind, std::string name, SensorsOfKind<Model, Preprocessing>& sensors) {
  sensors.own.push_back(load_entry<Model, Preprocessing>(yaml, std::move(name)));
  sensors.own.back().style.kind = name_of(kind);
}

class Check {
 public:
  Check(const Scenario& scenario, const schedules::model::Cluster& cluster) : scenario_(scenario), cluster_(cluster) {}

  template <class Model, class Preprocessing>
  void check(SensorKind kind, const SensorsOfKind<Model, Preprocessing>& sensors) {
    for (const auto& entry : sensors.own) check_own(kind, entry.name);
    for (const schedules::model::Sensor& sensor : cluster_.sensors)
      if (const auto& entry = sensors.of(sensor.name); sensor.kind == kind && entry.period)
        check_period(entry.name, *entry.period, sensor);
  }

  void finish() const { findings_.throw_if_any(); }

 private:
  void check_own(SensorKind kind, const std::string& name) {
    const auto id = cluster_.find_sensor(name);
    if (!id) {
      std::vector<std::string> names;
      for (const schedules::model::Sensor& sensor : cluster_.sensors) names.push_back(sensor.name);
      fail(
          name, "", "",
          fmt::format("must be a sensor of {}: {}{}", cluster_.file, joined(names, " or "), did_you_mean(name, names)));
    } else if (const SensorKind theirs = cluster_.sensor(*id).kind; theirs != kind) {
      fail(name, "kind", std::string(name_of(kind)),
           fmt::format("must be {}, as in {}", name_of(theirs), cluster_.file));
    } else if (is_recorded(cluster_)) {
      fail(name, "", "", fmt::format("must be absent: {} plays a recording of it", cluster_.file));
    }
  }

  void check_period(const std::string& name, Duration period, const schedules::model::Sensor& sensor) {
    if (is_recorded(cluster_)) return;
    const std::string_view where = cluster_.file;
    if (sensor.follows())
      fail(name, "period", text(period),
           fmt::format("must be absent: in {} {} measures at each end of {}", where, sensor.name, sensor.after));
    else if (sensor.period != period)
      fail(name, "period", text(period),
           fmt::format("must be {}, the period of {} in {}", text(sensor.period), sensor.name, where));
  }

  static std::string text(Duration period) { return fmt::format("{} ms", static_cast<double>(period.ns) * 1e-6); }

  void fail(const std::string& name, std::string_view key, std::string value, std::string expected) {
    Findings none;
    const YamlMap entry = StrictYaml::parse(scenario_.text, scenario_.file).root(none).map("sensors").map(name);
    findings_.add({scenario_.file, entry.line(key), fmt::format("sensors.{}{}{}", name, key.empty() ? "" : ".", key),
                   std::move(value), std::move(expected)});
  }

  const Scenario& scenario_;
  const schedules::model::Cluster& cluster_;
  Findings findings_;
};

}  // namespace

bool Sensors::enabled(const schedules::model::Sensor& sensor) const {
  switch (sensor.kind) {
    case SensorKind::kLaser: return lasers.of(sensor.name).model.device.enabled;
    case SensorKind::kCamera: return cameras.of(sensor.name).model.device.enabled;
    case SensorKind::kRadar: return radars.of(sensor.name).model.device.enabled;
    case SensorKind::kMonoCamera: return mono_cameras.of(sensor.name).model.device.enabled;
    case SensorKind::kOdometry: break;
  }
  return true;
}

Sensors load_sensors(YamlMap& yaml) {
  Sensors sensors;
  load_usual(yaml, SensorKind::kLaser, sensors.lasers);
  load_usual(yaml, SensorKind::kCamera, sensors.cameras);
  load_usual(yaml, SensorKind::kRadar, sensors.radars);
  load_usual(yaml, SensorKind::kMonoCamera, sensors.mono_cameras);
  load_usual(yaml, SensorKind::kOdometry, sensors.odometries);
  for (auto& [name, entry] : yaml.other_maps()) {
    if (entry.lacks("kind")) {  // it decides which other keys there are
      const std::vector<std::string> names = kind_names();
      entry.fail("kind", "is missing: must be one of " + joined(names) + did_you_mean(name, names));
      continue;
    }
    const SensorKind kind = entry.choice("kind", kKinds);
    switch (kind) {
      case SensorKind::kLaser: load_own(entry, kind, name, sensors.lasers); break;
      case SensorKind::kCamera: load_own(entry, kind, name, sensors.cameras); break;
      case SensorKind::kRadar: load_own(entry, kind, name, sensors.radars); break;
      case SensorKind::kMonoCamera: load_own(entry, kind, name, sensors.mono_cameras); break;
      case SensorKind::kOdometry: load_own(entry, kind, name, sensors.odometries); break;
    }
  }
  return sensors;
}

void load_preprocessing(YamlMap& yaml, Sensors& sensors) {
  const auto load_of = [&](SensorKind kind, auto& of_kind) {
    if (auto map = yaml.map_if(name_of(kind))) {
      load(*map, of_kind.preprocessing);
      map->finish();
    }
  };
  load_of(SensorKind::kLaser, sensors.lasers);
  load_of(SensorKind::kCamera, sensors.cameras);
  load_of(SensorKind::kRadar, sensors.radars);
  load_of(SensorKind::kMonoCamera, sensors.mono_cameras);
  load_of(SensorKind::kOdometry, sensors.odometries);
}

void meet(const sim::world::Weather& weather, Sensors& sensors) {
  const auto change = [&](auto& of_kind) {
    of_kind.usual.model = sim::world::in_weather(of_kind.usual.model, weather);
    for (auto& entry : of_kind.own) entry.model = sim::world::in_weather(entry.model, weather);
  };
  change(sensors.lasers);
  change(sensors.cameras);
  change(sensors.radars);
  change(sensors.mono_cameras);
}

void check_sensors(const Scenario& scenario, const schedules::model::Cluster& cluster) {
  Check check(scenario, cluster);
  check.check(SensorKind::kLaser, scenario.sensors.lasers);
  check.check(SensorKind::kCamera, scenario.sensors.cameras);
  check.check(SensorKind::kRadar, scenario.sensors.radars);
  check.check(SensorKind::kMonoCamera, scenario.sensors.mono_cameras);
  check.check(SensorKind::kOdometry, scenario.sensors.odometries);
  check.finish();
}

std::vector<recording::log::SensorStyle> sensor_styles(const Sensors& sensors,
                                                       const schedules::model::Cluster& cluster) {
  std::vector<recording::log::SensorStyle> styles;
  for (const schedules::model::Sensor& sensor : cluster.sensors) {
    styles.emplace_back();
    if (sensor.kind == SensorKind::kLaser) styles.back() = sensors.lasers.of(sensor.name).style;
    if (sensor.kind == SensorKind::kCamera) styles.back() = sensors.cameras.of(sensor.name).style;
    if (sensor.kind == SensorKind::kRadar) styles.back() = sensors.radars.of(sensor.name).style;
    if (sensor.kind == SensorKind::kMonoCamera) styles.back() = sensors.mono_cameras.of(sensor.name).style;
    if (sensor.kind == SensorKind::kOdometry) styles.back() = sensors.odometries.of(sensor.name).style;
  }
  while (!styles.empty() && styles.back() == recording::log::SensorStyle{}) styles.pop_back();
  return styles;
}

}  // namespace ttf::sim::drives
