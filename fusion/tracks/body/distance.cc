#include "fusion/tracks/body/distance.h"

#include <algorithm>
#include <cmath>

#include "fusion/tracks/body/behind.h"
#include "fusion/tracks/body/turn.h"

namespace ttf::fusion::tracks::body {
namespace {

using sensors::SeenPoint;

linear::Vector<2> place_of(const sensors::Observation& z, const sensors::Mounting& mounting) {
  if (z.kind == sensors::ObservationKind::kPosition) return z.z.head<2>();
  const double bearing = z.z(1) + mounting.yaw;
  return mounting.position + z.z(0) * linear::Vector<2>(std::cos(bearing), std::sin(bearing));
}

// Without a heading, a silhouette and a centre have a distance along the line of sight. Other points may be anywhere on the
// outline.
void put_unknown(Distance& distance, const Body& body, const linear::Vector<2>& at) {
  const Anchor& anchor = body.anchor;
  const bool of_silhouette = anchor.point == SeenPoint::kSilhouette,
             to_silhouette = distance.to.point == SeenPoint::kSilhouette;
  const bool behind = of_silhouette && distance.to.point == SeenPoint::kCentre;
  const bool before = anchor.point == SeenPoint::kCentre && to_silhouette;
  if (!behind && !before && !(of_silhouette && to_silhouette)) {
    distance.constant = 0.25 * body.extent.size.squaredNorm() * linear::Matrix<2>::Identity();
    return;
  }
  const linear::Vector<2> from = behind ? anchor.from : distance.to.from, sight = sight_to(at, from);
  const Behind centre = behind_of(body.extent, body.shown, (at - from).norm());
  distance.between = (behind ? 1.0 : before ? -1.0 : 0.0) * centre.depth * sight;
  distance.constant = covariance_of(centre, sight);
}

// The heading is the track's, if only by its course. One that is not sure names no corner.
std::optional<Anchor> outermost_of(const sensors::Observation& z, const Body& body,
                                   const estimators::Estimator& estimator) {
  const Facing facing = facing_of(estimator.cartesian(body.estimate), body.heading);
  if (facing.sigma > kBehindSilhouette.lost) return std::nullopt;
  const double heading = body.heading.known ? body.heading.value : facing.heading;
  return body::outermost_of(z.seen, z.heading, {std::cos(heading), std::sin(heading)}, z.z.head<2>(), z.from.position);
}

// Moves the observation from the distance's point to the anchor, with this covariance of the distance.
sensors::Observation moved(const sensors::Observation& z, const Distance& distance, const linear::Matrix<2>& spread,
                           const sensors::Mounting& mounting) {
  constexpr double kNearest = 0.1;  // [m], a radar's range that its bearing's lever is taken for, at least
  sensors::Observation result = z;
  if (z.kind == sensors::ObservationKind::kPosition) {
    result.z.head<2>() -= distance.between;
    result.r.topLeftCorner<2, 2>() += spread;
    return result;
  }
  // The range rate changes with the line of sight, and by the point's own motion about the anchor.
  const double bearing = z.z(1) + mounting.yaw, range = std::max(kNearest, z.z(0));
  const linear::Vector<2> sight(std::cos(bearing), std::sin(bearing)), left(-sight.y(), sight.x());
  linear::Matrix<3, 2> polar;
  polar.row(0) = sight.transpose();
  polar.row(1) = left.transpose() / range;
  polar.row(2) = distance.velocity.dot(left) / range * left.transpose();
  result.z -= polar * distance.between;
  result.z(2) -= distance.swing.dot(sight);
  const linear::Matrix<3> added = polar * spread * polar.transpose();
  result.r += 0.5 * (added + added.transpose());
  const double rate_by_turn = distance.by_rate.dot(sight);
  result.r(2, 2) += rate_by_turn * rate_by_turn;
  return result;
}

// The object's axes, along and across.
linear::Matrix<2> axes_of(const Distance& distance) {
  linear::Matrix<2> axes;
  axes << distance.axis, linear::Vector<2>(-distance.axis.y(), distance.axis.x());
  return axes;
}

}  // namespace

std::optional<Distance> distance_to(const Body& body, const estimators::Estimator& estimator,
                                    const sensors::Observation& z, const sensors::Mounting& mounting) {
  const Anchor& anchor = body.anchor;
  const bool has_sides = z.seen != SeenPoint::kCentre && z.seen != SeenPoint::kSilhouette;
  Distance distance;
  Direction direction{z.heading, z.sigma_heading};
  if (has_sides && body.heading.known) direction.heading = body.heading.value;
  distance.to = anchor_of(z.seen, place_of(z, mounting), direction.heading, mounting.position);
  if (is_outermost(z.seen)) {
    const std::optional<Anchor> corner = outermost_of(z, body, estimator);
    distance.is_vague = !corner;
    distance.to = corner.value_or(anchor);
  }
  if (z.seen == SeenPoint::kSilhouette) distance.to.sensor = z.sensor;
  if (distance.to == anchor && !distance.is_vague) return std::nullopt;

  const estimators::Cartesian estimate = estimator.cartesian(body.estimate);
  const linear::Vector<2> at = estimate.x.head<2>();
  const Turn turn = turn_of(estimate, body.heading);
  if (!z.has_heading || body.heading.known)
    direction = direction_of(body.heading, facing_at_centre(anchor, body.extent, body.heading, estimate, turn));
  distance.axis << std::cos(direction.heading), std::sin(direction.heading);
  distance.velocity = estimate.x.segment<2>(2);
  const bool with_silhouette = anchor.point == SeenPoint::kSilhouette || z.seen == SeenPoint::kSilhouette;
  const double weight = distance.is_vague ? 0.0 : direction.weight(with_silhouette ? kBehindSilhouette : kOfSides);
  const std::optional<Located> point =
      weight > 0.0 ? point_of(distance.to, anchor, at, {body.extent.size, direction.heading}) : std::nullopt;
  if (!point || weight < 1.0) put_unknown(distance, body, at);
  if (!point) return distance;
  const linear::Vector<2> by_heading = point->by_box.col(2), by_sigma = by_heading * direction.sigma;
  const linear::Matrix<2> by_size = point->by_box.leftCols<2>();
  const linear::Vector<2> apart = point->at - at - distance.between;
  distance.constant = weight * by_size * body.extent.covariance * by_size.transpose() +
                      (1.0 - weight) * distance.constant + weight * (1.0 - weight) * apart * apart.transpose();
  linear::symmetrise<2>(distance.constant);
  distance.between += weight * apart;
  distance.by_size = weight * by_size;
  distance.noise = weight * by_sigma * by_sigma.transpose();
  // A return comes from matter, which turns with the object. A silhouette moves along the outline, too, as another part of the
  // outline comes into view: the derivative by the heading is not its velocity.
  distance.by_rate = weight * std::sqrt(turn.variance) * quarter_on(point->at - at);
  distance.swing = weight * turn.rate * quarter_on(point->at - at);
  return distance;
}

sensors::Observation expected(const sensors::Observation& z, const Distance& distance,
                              const sensors::Mounting& mounting) {
  return moved(z, distance, distance.constant + distance.noise, mounting);
}

sensors::Observation counted(const sensors::Observation& z, const Distance& distance, const sensors::Mounting& mounting,
                             const linear::Matrix<2>& p) {
  constexpr double kNothing = 1e6;  // [m^2], the variance of a position that says nothing
  const linear::Matrix<2> axes = axes_of(distance), constant = axes.transpose() * distance.constant * axes;
  linear::Vector<2> added;
  for (Eigen::Index k = 0; k < 2; ++k) {
    const double c = constant(k, k) + std::abs(constant(0, 1)), before = axes.col(k).dot(p * axes.col(k));
    added(k) = before > c ? std::min(kNothing, std::max(c, before * c / (before - c))) : c > 0.0 ? kNothing : 0.0;
  }
  linear::Matrix<2> spread = distance.noise + axes * added.asDiagonal() * axes.transpose();
  linear::symmetrise<2>(spread);
  return moved(z, distance, spread, mounting);
}

void correct_size(Extent& extent, const sensors::Observation& z, const Distance& distance,
                  const linear::Gaussian<2>& at) {
  if (z.kind != sensors::ObservationKind::kPosition) return;
  const linear::Matrix<2> axes = axes_of(distance);
  const linear::Vector<2> off = z.z.head<2>() - at.x - distance.between;
  const linear::Matrix<2> white = z.r.topLeftCorner<2, 2>() + distance.noise;
  for (Eigen::Index k = 0; k < 2; ++k) {
    const linear::Vector<2> axis = axes.col(k);
    correct_combination(extent, distance.by_size.transpose() * axis, axis.dot(off), axis.dot(white * axis),
                        axis.dot(at.p * axis));
  }
}

Anchor first_anchor(const sensors::Observation& z, const sensors::Mounting& mounting) {
  Anchor anchor = anchor_of(z.seen, place_of(z, mounting), z.heading, mounting.position);
  if (z.seen == SeenPoint::kSilhouette) anchor.sensor = z.sensor;
  return anchor;
}

}  // namespace ttf::fusion::tracks::body
