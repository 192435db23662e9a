#include "fusion/sensors/known_sensor.h"

#include <algorithm>
#include <cmath>

#include "fusion/motion/angles.h"
#include "fusion/sensors/range_bearing.h"

namespace ttf::fusion::sensors {
namespace {

// An axis, or the direction into a face.
bool has_direction(const Observation& o) { return o.has_heading || is_outermost(o.seen); }

void turn(Observation& o, double angle) {
  linear::Matrix<2> rotation;
  const double c = std::cos(angle), s = std::sin(angle);
  rotation << c, -s, s, c;
  o.z.head<2>() = (rotation * o.z.head<2>()).eval();
  linear::Matrix<2> r = rotation * o.r.topLeftCorner<2, 2>() * rotation.transpose();
  linear::symmetrise<2>(r);
  o.r.topLeftCorner<2, 2>() = r;
  if (has_direction(o)) o.heading = motion::to_half_turn(o.heading + angle);
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
  const linear::Vector<2> at = turned({o.z(0), 0.0}, o.z(1)) - errors.known.head<2>();
  o.z(0) = std::max(at.norm(), sensors::kNearest);
  o.z(1) = std::atan2(at.y(), at.x());
}

}  // namespace

bool KnownSensor::plain() const {
  return mounting.position.isZero(0.0) && mounting.yaw == 0.0 && errors.known.isZero(0.0);
}

int count_biases(std::span<const KnownSensor> sensors) {
  int count = 0;
  for (const KnownSensor& sensor : sensors) count += static_cast<int>((sensor.errors.sigma.array() > 0.0).count());
  return count;
}

void place(Observation& observation, SensorId id, const KnownSensor& sensor) {
  observation.sensor = id;
  observation.rate_span = sensor.range_rate_span;
  if (sensor.plain()) return;
  observation.from = sensor.mounting;
  const bool position = observation.kind == ObservationKind::kPosition;
  if (!position) {
    correct_polar(observation, sensor.errors);
    if (has_direction(observation))
      observation.heading = motion::to_half_turn(observation.heading + sensor.mounting.yaw);
    return;
  }
  correct_position(observation, sensor.errors);
  if (sensor.mounting.yaw != 0.0) turn(observation, sensor.mounting.yaw);
  observation.z.head<2>() += sensor.mounting.position;
}

void carry(Observation& observation, const Mounting& vehicle) {
  observation.from = placed_on(vehicle, observation.from);
  if (observation.kind == ObservationKind::kPosition) {
    turn(observation, vehicle.yaw);
    observation.z.head<2>() += vehicle.position;
  } else if (has_direction(observation)) {
    observation.heading = motion::to_half_turn(observation.heading + vehicle.yaw);
  }
}

}  // namespace ttf::fusion::sensors
