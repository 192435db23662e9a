#include "fusion/loading/known_sensor.h"

#include <fmt/format.h>

#include <array>
#include <numbers>
#include <optional>

namespace ttf::fusion::loading {

using sensors::BlindSector, sensors::ErrorAxes, sensors::Field, sensors::KnownSensor;

namespace {

constexpr Range<double> kPlace{-50.0, 50.0}, kHeading{-7.0, 7.0};

// The name and the limits of a bias of one component.
struct Component {
  const char* name;
  ErrorAxes axes;
  int index;
  double most;
  const char* unit;
};
constexpr std::array<Component, 5> kComponents{{{"range", ErrorAxes::kPolar, 0, 10.0, "m"},
                                                {"bearing", ErrorAxes::kPolar, 1, 0.5, "rad"},
                                                {"range_rate", ErrorAxes::kPolar, 2, 10.0, "m/s"},
                                                {"x", ErrorAxes::kCartesian, 0, 10.0, "m"},
                                                {"y", ErrorAxes::kCartesian, 1, 10.0, "m"}}};

// Reads the given components, each from `least` times its most on.
template <class Values>
void read_components(YamlMap& yaml, double least, Values& values, std::optional<ErrorAxes>& axes) {
  for (const Component& component : kComponents) {
    if (!yaml.has(component.name)) continue;
    values(component.index) = yaml.number(component.name, {least * component.most, component.most}, component.unit);
    if (axes.value_or(component.axes) != component.axes)
      yaml.fail(component.name,
                "must not be mixed with errors in other axes: either x and y, or range, bearing and "
                "range_rate");
    axes = component.axes;
  }
}

Field load_field(YamlMap& yaml) {
  Field f;
  f.half_angle = yaml.number_or("half_angle", f.half_angle, {0.01, 3.15}, "rad");
  f.min_range = yaml.number_or("min_range", f.min_range, {0.0, 1e4}, "m");
  f.max_range = yaml.number_or("max_range", f.max_range, {0.1, 1e4}, "m");
  if (f.max_range <= f.min_range) yaml.fail("max_range", "must be above min_range");
  f.shadow = yaml.number_or("shadow", f.shadow, {0.0, 1e6});
  for (YamlMap& map : yaml.maps_if("blind")) {
    const BlindSector sector{map.number("from", kHeading, "rad"), map.number("to", kHeading, "rad")};
    if (sector.to <= sector.from || sector.to - sector.from > 2.0 * std::numbers::pi)
      map.fail("to", "must be above `from`, by at most a turn");
    map.finish();
    if (f.blind_sectors < Field::kMostBlind)
      f.blind[f.blind_sectors++] = sector;
    else
      yaml.fail("blind", fmt::format("must have at most {} sectors", Field::kMostBlind));
  }
  return f;
}

}  // namespace

KnownSensor load_known_sensor(YamlMap& yaml) {
  KnownSensor sensor;
  if (auto mounting = yaml.map_if("mounting")) {
    sensor.mounting.position.x() = mounting->number_or("x", 0.0, kPlace, "m");
    sensor.mounting.position.y() = mounting->number_or("y", 0.0, kPlace, "m");
    sensor.mounting.yaw = mounting->number_or("heading", 0.0, kHeading, "rad");
    mounting->finish();
  }
  if (auto field = yaml.map_if("field")) {
    sensor.field = load_field(*field);
    field->finish();
  }
  sensor.range_rate_span = yaml.number_or("range_rate_span", sensor.range_rate_span, {1.0, 400.0}, "m/s");
  std::optional<ErrorAxes> axes;
  if (auto bias = yaml.map_if("bias")) {
    read_components(*bias, -1.0, sensor.errors.known, axes);
    bias->finish();
  }
  if (auto sigma = yaml.map_if("bias_sigma")) {
    read_components(*sigma, 0.0, sensor.errors.sigma, axes);
    sensor.errors.sigma(3) =
        sigma->duration_or("time", Duration{}, {Duration{}, Duration::milliseconds(1000)}).seconds();
    sigma->finish();
  }
  sensor.errors.axes = axes.value_or(ErrorAxes::kPolar);
  return sensor;
}

void check_biases(std::span<const KnownSensor> sensors, YamlMap& yaml, std::string_view key) {
  const int count = count_biases(sensors);
  if (count > sensors::kMostBiases)
    yaml.fail(key, fmt::format("must have at most {} biases with a sigma above 0, of all sensors together, not {}",
                               sensors::kMostBiases, count));
}

}  // namespace ttf::fusion::loading
