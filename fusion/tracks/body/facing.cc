#include "fusion/tracks/body/facing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fusion/motion/angles.h"

namespace ttf::fusion::tracks::body {

// The mean square about the heading of a front that is half a turn off with the probability `reversed`.
double Facing::sigma_of_front() const {
  return reversed > 0.0 ? std::sqrt(sigma * sigma + std::numbers::pi * std::numbers::pi * reversed) : sigma;
}

Facing facing_of(const linear::Gaussian<2>& velocity, const Heading& axis) {
  constexpr double kVarianceOfAnyAngle = std::numbers::pi * std::numbers::pi / 3.0;
  const double vx = velocity.x(0), vy = velocity.x(1), speed = std::hypot(vx, vy);
  const Eigen::Vector2d along = speed > 1e-9 ? Eigen::Vector2d(vx / speed, vy / speed) : Eigen::Vector2d(1.0, 0.0);
  const Eigen::Vector2d across(-along(1), along(0));
  // The faster the object, the better its course gives the heading.
  const double course = std::atan2(along(1), along(0));
  const double course_variance = across.dot(velocity.p * across) / std::max(1e-6, speed * speed);
  const bool moving = course_variance < kVarianceOfAnyAngle / 4.0;
  // The end at which the front is: the remembered one, or else the one that the velocity points at, or that of the value.
  const bool course_ahead = nearest_half_turn(axis.value, course) == axis.value;
  bool front_ahead = course_ahead;
  double reversed = 0.0;
  if (axis.known && axis.front != 0) {
    // A course that noise cannot make counts against it: the axis has turned unseen.
    const bool sure = moving && speed > kResolvesFront * std::sqrt(along.dot(velocity.p * along));
    front_ahead = sure ? course_ahead : axis.front > 0;
  } else if (axis.known) {
    const double ahead = ahead_by(axis, velocity);
    if (!moving) front_ahead = ahead >= -1.0;
    reversed = 0.5 * std::erfc((front_ahead ? ahead : -ahead) / std::numbers::sqrt2);
  }
  const double front = front_ahead ? axis.value : motion::to_half_turn(axis.value + std::numbers::pi);
  if (moving && axis.known && front_ahead == course_ahead) {
    const double difference = motion::to_half_turn(front - course);
    const double weight = course_variance / (course_variance + axis.variance);
    return {motion::to_half_turn(course + weight * difference),
            std::sqrt(course_variance * axis.variance / (course_variance + axis.variance)),
            (1.0 - weight) / speed * across, weight * weight * axis.variance, reversed};
  }
  if (axis.known) return {motion::to_half_turn(front), std::sqrt(axis.variance), {0.0, 0.0}, axis.variance, reversed};
  if (moving) return {course, std::sqrt(course_variance), across / speed, 0.0};
  return {course, std::sqrt(kVarianceOfAnyAngle), {0.0, 0.0}, kVarianceOfAnyAngle};
}

}  // namespace ttf::fusion::tracks::body
