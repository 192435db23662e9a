#include "fusion/sensors/known_sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "fusion/motion/angles.h"
#include "fusion/sensors/range_bearing.h"

namespace ttf::fusion::sensors {
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

linear::Vector<2> rotated(const linear::Vector<2>& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

void turn(Observation& o, double angle) {
  linear::Matrix<2> rotation;
  const double c = std::cos(angle), s = std::sin(angle);
  rotation << c, -s, s, c;
  o.z.head<2>() = (rotation * o.z.head<2>()).eval();
  linear::Matrix<2> r = rotation * o.r.topLeftCorner<2, 2>() * rotation.transpose();
  linear::symmetrise<2>(r);
  o.r.topLeftCorner<2, 2>() = r;
  if (o.has_heading) o.heading = motion::to_half_turn(o.heading + angle);
}

void correct_position(Observation& o, const SystematicErrors& errors) {
  if (errors.axes == ErrorAxes::kCartesian) {
    o.z.head<2>() -= errors.known.head<2>();
    return;
  }
  const double range = o.z.head<2>().norm();
  if (range < sensors::kNearest) return;
  o.z.head<2>() *= std::max(range - errors.known(0), sensors::kNearest) / range;
  if (errors.known(1) != 0.0) turn(o, -errors.known(1));
}

void correct_polar(Observation& o, const SystematicErrors& errors) {
  if (errors.axes == ErrorAxes::kPolar) {
    o.z -= errors.known;
    o.z(0) = std::max(o.z(0), sensors::kNearest);
    return;
  }
  const linear::Vector<2> at = rotated({o.z(0), 0.0}, o.z(1)) - errors.known.head<2>();
  o.z(0) = std::max(at.norm(), sensors::kNearest);
  o.z(1) = std::atan2(at.y(), at.x());
}

Field load_field(YamlMap& yaml) {
  Field f;
  f.half_angle = yaml.number_or("half_angle", f.half_angle, {0.01, 3.15}, "rad");
  f.min_range = yaml.number_or("min_range", f.min_range, {0.0, 1e4}, "m");
  f.max_range = yaml.number_or("max_range", f.max_range, {0.1, 1e4}, "m");
  if (f.max_range <= f.min_range) yaml.fail("max_range", "must be above min_range");
  f.shadow = yaml.number_or("shadow", f.shadow, {0.0, 1e6});
  return f;
}

}  // namespace

bool KnownSensor::plain() const {
  return mounting.position.isZero(0.0) && mounting.yaw == 0.0 && errors.known.isZero(0.0);
}

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

int count_biases(std::span<const KnownSensor> sensors) {
  int count = 0;
  for (const KnownSensor& sensor : sensors) count += static_cast<int>((sensor.errors.sigma.array() > 0.0).count());
  return count;
}

void check_biases(std::span<const KnownSensor> sensors, YamlMap& yaml, std::string_view key) {
  const int count = count_biases(sensors);
  if (count > kMostBiases)
    yaml.fail(key, fmt::format("must have at most {} biases with a sigma above 0, of all sensors together, not {}",
                               kMostBiases, count));
}

void place(Observation& observation, SensorId id, const KnownSensor& sensor) {
  observation.sensor = id;
  if (sensor.plain()) return;
  const bool position = observation.kind == ObservationKind::kPosition;
  if (!position) {
    correct_polar(observation, sensor.errors);
    if (observation.has_heading) observation.heading = motion::to_half_turn(observation.heading + sensor.mounting.yaw);
    return;
  }
  correct_position(observation, sensor.errors);
  if (sensor.mounting.yaw != 0.0) turn(observation, sensor.mounting.yaw);
  observation.z.head<2>() += sensor.mounting.position;
}

}  // namespace ttf::fusion::sensors
