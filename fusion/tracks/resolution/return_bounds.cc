#include "fusion/tracks/resolution/return_bounds.h"

#include <algorithm>
#include <cmath>

#include "fusion/motion/angles.h"

namespace ttf::fusion::tracks::resolution {
namespace {

constexpr double kNearest = 0.1;  // [m]

}  // namespace

// In the axes of the box. A corner is visible if one of its sides faces the sensor. Between two visible corners the range is nearest
// where the sensor is beside the side.
ReturnBounds bounds_of(const body::SeenBox& outline) {
  const linear::Vector<2> along(std::cos(outline.box.heading), std::sin(outline.box.heading)),
      across(-along.y(), along.x()), half = 0.5 * outline.box.size;
  const linear::Vector<2> sensor(-along.dot(outline.centre), -across.dot(outline.centre));
  const double middle = std::atan2(outline.centre.y(), outline.centre.x());
  const linear::Vector<2> beyond = (sensor.cwiseAbs() - half).cwiseMax(0.0);
  ReturnBounds bounds;
  bool any = false;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-1.0, 1.0}) {
      if (!(a * sensor.x() > half.x() || b * sensor.y() > half.y())) continue;
      const linear::Vector<2> lever = a * half.x() * along + b * half.y() * across, at = outline.centre + lever;
      const linear::Vector<2> velocity =
          outline.velocity + outline.turn_rate * linear::Vector<2>(-lever.y(), lever.x());
      const linear::Vector<3> seen(at.norm(), middle + motion::to_half_turn(std::atan2(at.y(), at.x()) - middle),
                                   at.normalized().dot(velocity));
      bounds.low = any ? linear::Vector<3>(bounds.low.cwiseMin(seen)) : seen;
      bounds.high = any ? linear::Vector<3>(bounds.high.cwiseMax(seen)) : seen;
      any = true;
    }
  bounds.low(0) = beyond.norm();
  // Along a line of sight v, the range rate of all matter is the one that the velocity of the outline, turned about the sensor, has
  // there. So it is largest along that velocity, and least against it.
  const linear::Vector<2> v =
      outline.velocity - outline.turn_rate * linear::Vector<2>(-outline.centre.y(), outline.centre.x());
  const auto is_in_view = [&](const linear::Vector<2>& direction) {
    const double bearing = middle + motion::to_half_turn(std::atan2(direction.y(), direction.x()) - middle);
    return bearing > bounds.low(1) && bearing < bounds.high(1);
  };
  if (any && v.norm() > 0.0) {
    if (is_in_view(v)) bounds.high(2) = std::max(bounds.high(2), v.norm());
    if (is_in_view(-v)) bounds.low(2) = std::min(bounds.low(2), -v.norm());
  }
  return bounds;
}

// The facing edges have the least difference of azimuths. A larger one allows a larger difference of the range rates.
bool may_join(const ReturnBounds& a, const ReturnBounds& b, const sensors::Resolution& resolution) {
  const linear::Vector<3> half = 0.5 * (a.high - a.low + b.high - b.low),
                          middle = 0.5 * (b.low + b.high - a.low - a.high);
  const double range = std::max(kNearest, std::min(a.low(0), b.low(0)));
  const double further = std::max(0.0, std::abs(middle(0)) - half(0));
  const double turn = std::abs(motion::to_half_turn(middle(1)));
  const double least = std::max(0.0, turn - half(1)), allowed = resolution.across(range) / range;
  const double faster = std::max(0.0, std::abs(std::remainder(middle(2), resolution.rate_span_mps)) - half(2));
  return least <= allowed &&
         resolution.joins(range, further, std::min(turn + half(1), std::nextafter(allowed, 0.0)), faster);
}

}  // namespace ttf::fusion::tracks::resolution
