#include "nodes/control/time_to_collision.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ttf::nodes::control {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// When the vehicle stands; never without braking.
double stands_at(const InLine& vehicle) {
  if (vehicle.speed <= 0.0) return vehicle.acceleration > 0.0 ? kNever : 0.0;
  return vehicle.acceleration < 0.0 ? -vehicle.speed / vehicle.acceleration : kNever;
}

InLine later(const InLine& vehicle, double seconds, bool stands) {
  if (stands) return {};
  return {vehicle.speed + vehicle.acceleration * seconds, vehicle.acceleration};
}

// The first instant after 0 at which clearance - closing t - growth t^2 / 2 is 0.
double first_touch(double clearance, double closing, double growth) {
  if (growth == 0.0) return closing > 0.0 ? clearance / closing : kNever;
  const double discriminant = closing * closing + 2.0 * growth * clearance;
  if (discriminant < 0.0) return kNever;
  const double root = std::sqrt(discriminant);
  // The forms without cancellation. The clearance is positive, so of two positive roots the first form has the smaller one.
  if (closing >= 0.0) return 2.0 * clearance / (closing + root);
  return growth > 0.0 ? (root - closing) / growth : kNever;
}

}  // namespace

double time_to_collision(double clearance, double closing_speed) {
  if (clearance <= 0.0) return 0.0;
  return closing_speed > 0.0 ? clearance / closing_speed : kNever;
}

double time_to_collision(double clearance, const InLine& own, const InLine& ahead) {
  double passed = 0.0;
  InLine rear = own, front = ahead;
  // The clearance is quadratic until the first vehicle stands, then until the second does, and then for ever.
  for (int piece = 0; piece < 3; ++piece) {
    if (clearance <= 0.0) return passed;
    const double rear_stands = stands_at(rear), front_stands = stands_at(front);
    if (rear_stands == 0.0) rear = {};
    if (front_stands == 0.0) front = {};
    const double closing = rear.speed - front.speed, growth = rear.acceleration - front.acceleration;
    double length = kNever;
    if (rear_stands > 0.0) length = std::min(length, rear_stands);
    if (front_stands > 0.0) length = std::min(length, front_stands);
    const double touch = first_touch(clearance, closing, growth);
    if (touch <= length || length == kNever) return passed + touch;
    clearance -= closing * length + 0.5 * growth * length * length;
    passed += length;
    rear = later(rear, length, rear_stands <= length);
    front = later(front, length, front_stands <= length);
  }
  return kNever;
}

}  // namespace ttf::nodes::control
