#include "fusion/tracks/track.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fusion/motion/angles.h"
#include "fusion/tracks/anchoring.h"

namespace ttf::fusion::tracks {

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
    const bool sure = moving && speed > kTellsFront * std::sqrt(along.dot(velocity.p * along));
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

bool given_up(const Track& track, GlobalTime time, GlobalTime at, const config::TrackerConfig& config,
              const estimators::Estimator& estimator) {
  at = std::max(at, time);
  const Duration silent = at - track.newest.measured;
  if (silent <= config.coast_after) return false;
  if (silent > config.delete_after) return true;
  estimators::Estimate estimate = track.estimate;
  estimator.predict(estimate, (at - time).seconds());
  const double largest = config.delete_position_sigma * config.delete_position_sigma;
  return estimator.position(estimate).p.diagonal().maxCoeff() > largest;
}

TrackView view_of(const Track& track, GlobalTime time, GlobalTime at, const config::TrackerConfig& config,
                  const estimators::Estimator& estimator) {
  estimators::Estimate later = track.estimate;
  const double dt = std::max(0.0, (at - time).seconds());
  estimator.predict(later, dt);
  const estimators::Cartesian anchor = estimator.cartesian(later);
  const Heading axis = predicted(track.heading, config, anchor.x.segment<2>(2).norm(), dt);
  Extent extent = track.extent;
  predict(extent, config.extent_noise, dt);
  const Centre centre = centred(track.anchor, extent, axis, predicted(track.shown, kTurningSilhouette, dt), anchor);
  const estimators::Cartesian& estimate = centre.estimate;
  TrackView view;
  view.id = track.id;
  view.valid_at = std::max(at, time);
  view.state = estimate.x;
  view.covariance = estimate.p;
  view.confirmed = track.confirmed;
  view.coasting = track.misses >= config.coast_misses || view.valid_at - track.newest.measured > config.coast_after;

  const double vx = estimate.x(2), vy = estimate.x(3);
  view.speed = std::hypot(vx, vy);
  const Eigen::Vector2d along =
      view.speed > 1e-9 ? Eigen::Vector2d(vx / view.speed, vy / view.speed) : Eigen::Vector2d(1.0, 0.0);
  const Eigen::Matrix2d velocity = estimate.p.block<2, 2>(2, 2);
  view.sigma_speed = std::sqrt(along.dot(velocity * along));

  view.heading = centre.facing.heading;
  view.sigma_heading = centre.facing.sigma_of_front();
  const Eigen::Vector2d direction(std::cos(view.heading), std::sin(view.heading));
  const Eigen::Matrix2d acceleration = estimate.p.block<2, 2>(4, 4);
  view.acceleration = direction.dot(estimate.x.segment<2>(4));
  view.sigma_acceleration = std::sqrt(std::max(0.0, direction.dot(acceleration * direction)));

  view.length = extent.size(0);
  view.sigma_length = std::sqrt(extent.covariance(0, 0));
  view.has_length = extent.knows_length();
  view.width = extent.size(1);
  view.sigma_width = std::sqrt(extent.covariance(1, 1));
  view.has_width = extent.knows_width();
  view.unfiltered = track.unfiltered;
  return view;
}

}  // namespace ttf::fusion::tracks
