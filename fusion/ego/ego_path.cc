#include "fusion/ego/ego_path.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "fusion/motion/angles.h"
#include "fusion/motion/turn_moments.h"
#include "fusion/sensors/known_sensor.h"
#include "fusion/sensors/range_bearing_rate.h"

namespace ttf::fusion::ego {
namespace {

using linear::Vector;

double square(double x) { return x * x; }

// Returns int v (cos h, sin h) - slip v^2 w (-sin h, cos h) over `seconds`, where the heading h begins at zero, and the speed v
// and the yaw rate w change linearly.
Vector<2> travelled(double speed, double by_speed, double yaw_rate, double by_yaw_rate, double slip, double seconds) {
  constexpr double kInner = 0.33998104358485626, kOuter = 0.86113631159405258;  // sqrt(3/7 -+ 2/7 sqrt(6/5))
  constexpr double kHeavy = 0.32607257743127307, kLight = 0.17392742256872693;  // (18 +- sqrt(30)) / 72
  constexpr double kNodes[] = {-kOuter, -kInner, kInner, kOuter}, kWeights[] = {kLight, kHeavy, kHeavy, kLight};
  Vector<2> sum = Vector<2>::Zero();
  for (int i = 0; i < 4; ++i) {
    const double s = 0.5 * seconds * (1.0 + kNodes[i]), heading = (yaw_rate + 0.5 * by_yaw_rate * s) * s;
    const double v = speed + by_speed * s, c = std::cos(heading), sine = std::sin(heading);
    sum += kWeights[i] * seconds * v * Vector<2>(c, sine);
    if (slip != 0.0) sum -= kWeights[i] * seconds * slip * v * v * (yaw_rate + by_yaw_rate * s) * Vector<2>(-sine, c);
  }
  return sum;
}

}  // namespace

EgoPath::EgoPath(const OdometryErrors& errors, std::size_t remembered) : errors_(errors), knots_(remembered) {}

bool EgoPath::accept(const OdometrySample& sample) {
  if (started() && sample.at <= newest().at) return false;
  Knot knot{.sample = sample};
  knot.sample.speed /= 1.0 + errors_.speed_scale;
  knot.sample.yaw_rate -= errors_.yaw_rate_bias;
  if (started()) {
    const Knot& before = at_index(count_ - 1);
    const sensors::Mounting vehicle = moved_on(before, &knot.sample, sample.at);
    knot.position = vehicle.position;
    knot.heading = vehicle.yaw;
  }
  if (count_ == knots_.size()) {
    first_ = (first_ + 1) % knots_.size();
    --count_;
  }
  knots_[(first_ + count_++) % knots_.size()] = knot;
  return true;
}

// Returns the vehicle's place at `time`, which is not before `from` and, if there is a next sample, not after that.
sensors::Mounting EgoPath::moved_on(const Knot& from, const OdometrySample* next, GlobalTime time) const {
  const double dt = (time - from.sample.at).seconds();
  double speed = from.sample.speed, yaw_rate = from.sample.yaw_rate, turn = yaw_rate * dt;
  Vector<2> way;
  if (next && next->at - from.sample.at <= errors_.longest_age) {
    const double whole = (next->at - from.sample.at).seconds();
    const double by_speed = (next->speed - speed) / whole, by_yaw_rate = (next->yaw_rate - yaw_rate) / whole;
    way = travelled(speed, by_speed, yaw_rate, by_yaw_rate, errors_.slip, dt);
    turn += 0.5 * by_yaw_rate * dt * dt;
    speed += by_speed * dt;
    yaw_rate += by_yaw_rate * dt;
  } else {
    const motion::TurnMoments moments = motion::turn_moments(turn);
    way = speed * dt * Vector<2>(moments.c[0], moments.s[0]);
    if (errors_.slip != 0.0) way += aside(speed, yaw_rate) * dt * Vector<2>(-moments.s[0], moments.c[0]);
  }
  sensors::Mounting vehicle;
  vehicle.position = from.position + sensors::turned(way, from.heading);
  vehicle.yaw = motion::to_half_turn(from.heading + turn);
  vehicle.yaw_rate = yaw_rate;
  vehicle.velocity = speed * Vector<2>(std::cos(vehicle.yaw), std::sin(vehicle.yaw));
  if (errors_.slip != 0.0)
    vehicle.velocity += aside(speed, yaw_rate) * Vector<2>(-std::sin(vehicle.yaw), std::cos(vehicle.yaw));
  return vehicle;
}

std::optional<EgoState> EgoPath::at(GlobalTime time) const {
  if (!started() || time < at_index(0).sample.at) return std::nullopt;
  // The last knot that is not after `time`.
  std::size_t low = 0, high = count_;
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (at_index(middle).sample.at <= time ? low : high) = middle;
  }
  const Knot& from = at_index(low);
  EgoState ego;
  ego.vehicle = moved_on(from, low + 1 < count_ ? &at_index(low + 1).sample : nullptr, time);
  if (low + 1 < count_) return ego;
  const double beyond = (time - from.sample.at).seconds();
  ego.along_variance =
      square(from.sample.speed_sigma * beyond) + square(0.5 * errors_.acceleration_sigma * beyond * beyond);
  ego.turn_variance =
      square(from.sample.yaw_rate_sigma * beyond) + square(0.5 * errors_.yaw_acceleration_sigma * beyond * beyond);
  ego.behind = 0.5 * from.sample.speed * beyond;
  return ego;
}

void carry(sensors::Observation& z, const EgoState& ego) {
  sensors::carry(z, ego.vehicle);
  if (ego.along_variance == 0.0 && ego.turn_variance == 0.0) return;
  const Vector<2> ahead(std::cos(ego.vehicle.yaw), std::sin(ego.vehicle.yaw));
  const bool is_position = z.kind == sensors::ObservationKind::kPosition;
  const double bearing = is_position ? 0.0 : z.z(1) + z.from.yaw;
  const Vector<2> sight(std::cos(bearing), std::sin(bearing));
  const Vector<2> at = is_position ? Vector<2>(z.z.head<2>()) : Vector<2>(z.from.position + z.z(0) * sight);
  const Vector<2> lever = at - ego.vehicle.position + ego.behind * ahead, swing(-lever.y(), lever.x());
  // The error of the pose moves the object's place by these, for a metre and a radian.
  Eigen::Vector2d by_along = ahead, by_turn = swing;
  if (!is_position) {
    const double range = std::max(sensors::kNearest, z.z(0));
    const auto polar = [&](const Vector<2>& moved) {
      return Eigen::Vector2d(sight.dot(moved), (sight.x() * moved.y() - sight.y() * moved.x()) / range);
    };
    by_along = polar(ahead);
    by_turn = polar(swing);
  }
  z.r.topLeftCorner<2, 2>() +=
      ego.along_variance * by_along * by_along.transpose() + ego.turn_variance * by_turn * by_turn.transpose();
  if (z.has_heading) z.sigma_heading = std::sqrt(z.sigma_heading * z.sigma_heading + ego.turn_variance);
}

}  // namespace ttf::fusion::ego
