#include "fusion/tracks/anchoring.h"

#include <algorithm>
#include <cmath>

#include "fusion/motion/kernels.h"

namespace ttf::fusion::tracks {
namespace {

using sensors::SeenPoint;

// A heading with a standard deviation [rad] below the first is sure, and beyond the second it is lost. Behind a silhouette
// that is earlier: there the shown width says more. Between them the weight falls smoothly.
struct Sureness {
  double sure, lost;
};
constexpr Sureness kBehindSilhouette{kSureHeading, 0.35}, kOfSides{0.5, 1.0};

struct Direction {
  double heading = 0.0, sigma = 0.0;
  double weight(const Sureness& limits) const {
    const double t = std::clamp((limits.lost - sigma) / (limits.lost - limits.sure), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
  }
};

// The direction of the object's length, in the sense of its measured axis if that is known.
Direction direction_of(const Scalar& axis, const Facing& facing) {
  return {axis.known ? nearest_half_turn(facing.heading, axis.value) : facing.heading, facing.sigma};
}

// The centre of an object of unknown heading lies so far behind its silhouette. The variances are along and across the line
// of sight.
struct Behind {
  double depth = 0.0, along = 0.0, across = 0.0;
};

// A rectangle L by W under a silhouette of width B has the mean chord L W / B. Its centre lies half of that behind. This is
// exact in the far field. The outermost corners are opposite ones: (u, v) and (-u, -v) from the centre. Here u = B / 2 and
// u^2 + v^2 = (L^2 + W^2) / 4. They move the silhouette's middle by u v / range, to an unknown side. No width may be
// measured. Then the mean of half the length and half the width counts.
Behind behind_of(const Extent& extent, const Scalar& shown, double range) {
  const double length = extent.size.maxCoeff(), width = extent.size.minCoeff();
  if (!shown.known) {
    const double spread = 0.5 * ((length - width) / std::sqrt(3.0) + width);
    return {0.25 * (length + width), spread * spread, spread * spread};
  }
  const double seen = std::clamp(shown.value, width, length), depth = 0.5 * length * width / seen;
  const linear::Vector<2> by_size = depth * extent.size.cwiseInverse();
  const double by_seen = depth / seen, half = 0.5 * seen, narrow = width / seen;
  const double far =
      std::max(0.0, 0.25 * (length * length + width * width) - half * half) / std::max(1.0, range * range);
  return {depth, by_size.dot(extent.covariance * by_size) + by_seen * by_seen * shown.variance,
          half * half * far * (1.0 - narrow * narrow) + 0.25 * shown.variance};
}
linear::Matrix<2> covariance_of(const Behind& behind, const linear::Vector<2>& sight) {
  const linear::Vector<2> across(-sight.y(), sight.x());
  return behind.along * sight * sight.transpose() + behind.across * across * across.transpose();
}
linear::Vector<2> sight_to(const linear::Vector<2>& point, const linear::Vector<2>& from) {
  const linear::Vector<2> sight = point - from;
  const double range = sight.norm();
  if (!(range > 0.0)) return linear::Vector<2>::UnitX();
  return sight / range;
}

// Turned by a quarter to the left: the velocity of a point at `a` that turns about the origin with 1 rad/s.
linear::Vector<2> quarter_on(const linear::Vector<2>& a) { return {-a.y(), a.x()}; }

// The turn rate [rad/s]. It is the motion's with the weight 1 - own, and the heading's with the weight `own`.
struct Turn {
  double rate = 0.0, variance = 0.0;
  double own = 1.0;
  linear::Vector<4> by = linear::Vector<4>::Zero();  // derivatives by velocity and acceleration
};

Turn turn_of(const estimators::Cartesian& estimate, const Heading& axis) {
  constexpr double kStanding = 1e-2;  // [m/s]
  Turn turn{.rate = axis.rate, .variance = axis.rate_variance};
  const linear::Vector<2> v = estimate.x.segment<2>(2), a = estimate.x.tail<2>();
  const double squared = v.squaredNorm();
  if (estimate.p(4, 4) + estimate.p(5, 5) <= 0.0 || squared < kStanding * kStanding) return turn;
  const linear::Matrix<4> p = estimate.p.bottomRightCorner<4, 4>();
  const double rate = (v.x() * a.y() - v.y() * a.x()) / squared;
  const linear::Vector<4> by =
      linear::Vector<4>(a.y() - 2.0 * v.x() * rate, -a.x() - 2.0 * v.y() * rate, -v.y(), v.x()) / squared;
  const double variance = by.dot(p * by), sum = variance + axis.rate_variance;
  turn.own = sum > 0.0 ? variance / sum : 0.0;
  turn.rate = turn.own * axis.rate + (1.0 - turn.own) * rate;
  turn.by = (1.0 - turn.own) * by;
  turn.variance = turn.own * axis.rate_variance;
  return turn;
}

// Returns from the anchor to the centre, roughly, of an object with this heading.
linear::Vector<2> lever_of(const Anchor& anchor, const Extent& extent, double heading, const linear::Vector<2>& at) {
  const linear::Vector<2> along(std::cos(heading), std::sin(heading));
  if (anchor.point != SeenPoint::kSilhouette)
    return -0.5 * (anchor.along * extent.size(0) * along + anchor.across * extent.size(1) * quarter_on(along));
  const linear::Vector<2> sight = sight_to(at, anchor.from);
  const double shown =
      extent.size(0) * std::abs(sight.dot(quarter_on(along))) + extent.size(1) * std::abs(sight.dot(along));
  return 0.5 * extent.size.prod() / std::max(extent.size.minCoeff(), shown) * sight;
}

// Returns the direction of the object's front, by the course of its centre.
Facing facing_at_centre(const Anchor& anchor, const Extent& extent, const Heading& axis,
                        const estimators::Cartesian& estimate, const Turn& turn) {
  linear::Gaussian<2> velocity = estimators::velocity_of(estimate);
  const Facing by_anchor = facing_of(velocity, axis);
  if (anchor.point == SeenPoint::kCentre || (turn.rate == 0.0 && turn.variance == 0.0)) return by_anchor;
  const Direction direction = direction_of(axis, by_anchor);
  const linear::Vector<2> swing = quarter_on(lever_of(anchor, extent, direction.heading, estimate.x.head<2>()));
  velocity.x += turn.rate * swing;
  const linear::Matrix<2> spread = turn.variance * swing * swing.transpose();
  velocity.p += 0.5 * (spread + spread.transpose());
  return facing_of(velocity, axis);
}

// Returns M P M', where M begins with the two columns of the identity. The order of the sums is written out, so that fewer
// rows give the same bits, and fewer columns, too, where the rest of P is zero.
template <int R, int K>
[[gnu::flatten]] linear::Matrix<R> carried(const linear::Matrix<R, K>& m, const linear::Matrix<K>& p) {
  linear::Matrix<R, K> mp;
  motion::unrolled<K>([&](int c) {
    linear::Vector<R> column = linear::Vector<R>::Zero();
    column.template head<2>() = p.col(c).template head<2>();
    motion::unrolled<K - 2>([&](int k) { column += p(k + 2, c) * m.col(k + 2); });
    mp.col(c) = column;
  });
  linear::Matrix<R> result;
  motion::unrolled<R>([&](auto row) {
    constexpr int r = row;
    if constexpr (r == 0)
      result.col(r) = mp.col(0) + m(r, 2) * mp.col(2);
    else if constexpr (r == 1)
      result.col(r) = mp.col(1) + m(r, 2) * mp.col(2);
    else
      result.col(r) = m(r, 2) * mp.col(2);
    if constexpr (K == 6)
      result.col(r) += m(r, 3) * mp.col(3) + (m(r, 4) * mp.col(4) + m(r, 5) * mp.col(5));
    else
      result.col(r) += m(r, 3) * mp.col(3);
  });
  return result;
}

// The first R of a centre's components are functions of the first K of its anchor's: all six, or four if the model knows no
// acceleration. Images need all of them, and most others the position alone.
//
// Returns the centre by its place in the object. With u = d centre / d heading and the turn rate w, its velocity is
// v + w u, and its acceleration a + w^2 u', where u' is u on by a quarter turn.
template <int R, int K>
[[gnu::flatten]] linear::Gaussian<R> turned(const Located& centre, const Extent& extent, const Heading& axis,
                                            const Facing& facing, const Turn& turn,
                                            const estimators::Cartesian& estimate) {
  const double w = turn.rate;
  const linear::Vector<2> u = centre.by_box.col(2), on = quarter_on(u);
  const linear::Matrix<2> by_size = centre.by_box.leftCols<2>();
  linear::Gaussian<R> result;
  linear::Vector<R> by_heading, by_rate = linear::Vector<R>::Zero();
  linear::Matrix<R, 2> by_sizes;
  result.x.template head<2>() = centre.at;
  by_heading.template head<2>() = u;
  by_sizes.template topRows<2>() = by_size;
  if constexpr (R >= 4) {
    result.x.template segment<2>(2) = estimate.x.segment<2>(2) + w * u;
    by_heading.template segment<2>(2) = w * on;
    by_rate.template segment<2>(2) = u;
    for (Eigen::Index side = 0; side < 2; ++side)
      by_sizes.template block<2, 1>(2, side) = quarter_on(w * by_size.col(side));
  }
  if constexpr (R == 6) {
    result.x.template tail<2>() = estimate.x.tail<2>() + w * w * on;
    by_heading.template tail<2>() = -w * w * u;
    by_rate.template tail<2>() = 2.0 * w * on;
    by_sizes.template bottomRows<2>() = -w * w * by_size;
  }
  // The heading depends on the centre's course, which depends on the turn rate.
  const double swings = facing.by_velocity.dot(u);
  Eigen::Matrix<double, 1, K> rate_by = Eigen::Matrix<double, 1, K>::Zero(), heading_by = rate_by;
  rate_by.template tail<K - 2>() = turn.by.head<K - 2>().transpose();
  heading_by.template segment<2>(2) = facing.by_velocity.transpose();
  heading_by += swings * rate_by;
  const linear::Matrix<R, K> map = linear::Matrix<R, K>::Identity() + by_heading * heading_by + by_rate * rate_by;
  const linear::Vector<R> own_rate = turn.own * (by_rate + swings * by_heading);
  // The axis has the share of the heading that the course leaves it, and is correlated with its own rate.
  const bool shares = axis.known && axis.variance > 0.0;
  const double share = shares ? std::sqrt(facing.axis_variance / axis.variance) : 0.0;
  const linear::Vector<R> mixed = share * axis.covariance * by_heading, weighted = facing.axis_variance * by_heading,
                          weighted_rate = axis.rate_variance * own_rate;
  const linear::Matrix<R, 2> by_covariance = by_sizes * extent.covariance;
  result.p = carried<R, K>(map, estimate.p.topLeftCorner<K, K>());
  motion::unrolled<R>([&](int c) {
    result.p.col(c) += by_sizes(c, 0) * by_covariance.col(0) + by_sizes(c, 1) * by_covariance.col(1);
    result.p.col(c) += by_heading(c) * weighted;
    result.p.col(c) += own_rate(c) * weighted_rate;
    result.p.col(c) += own_rate(c) * mixed;
    result.p.col(c) += mixed(c) * own_rate;
  });
  linear::symmetrise<R>(result.p);
  return result;
}

template <int R>
linear::Gaussian<R> turned(const Located& centre, const Extent& extent, const Heading& axis, const Facing& facing,
                           const Turn& turn, const estimators::Cartesian& estimate) {
  if (estimate.p(4, 4) + estimate.p(5, 5) > 0.0) return turned<R, 6>(centre, extent, axis, facing, turn, estimate);
  constexpr int kMoves = std::min(R, 4);
  const linear::Gaussian<kMoves> moves = turned<kMoves, 4>(centre, extent, axis, facing, turn, estimate);
  if constexpr (R == kMoves) {
    return moves;
  } else {
    linear::Gaussian<R> result;
    result.x << moves.x, estimate.x.tail<R - kMoves>();
    result.p.template topLeftCorner<kMoves, kMoves>() = moves.p;
    return result;
  }
}

template <int R>
linear::Gaussian<R> mixture(const linear::Gaussian<R>& a, double weight, const linear::Gaussian<R>& b) {
  const linear::Vector<R> apart = a.x - b.x;
  linear::Gaussian<R> result;
  result.x = b.x + weight * apart;
  result.p = weight * a.p + (1.0 - weight) * b.p + weight * (1.0 - weight) * apart * apart.transpose();
  linear::symmetrise<R>(result.p);
  return result;
}

// Returns the centre by the line of sight alone. It swings about its silhouette, too.
template <int R>
linear::Gaussian<R> behind(const Anchor& anchor, const Extent& extent, const Scalar& shown, const Turn& turn,
                           const estimators::Cartesian& estimate) {
  const linear::Vector<2> at = estimate.x.head<2>(), sight = sight_to(at, anchor.from), across = quarter_on(sight);
  const Behind behind = behind_of(extent, shown, (at - anchor.from).norm());
  linear::Gaussian<R> result{estimate.x.head<R>(), estimate.p.topLeftCorner<R, R>()};
  result.x.template head<2>() += behind.depth * sight;
  result.p.template topLeftCorner<2, 2>() += covariance_of(behind, sight);
  if constexpr (R >= 4)
    result.p.template block<2, 2>(2, 2) +=
        (turn.rate * turn.rate + turn.variance) * behind.depth * behind.depth * across * across.transpose();
  linear::symmetrise<R>(result.p);
  return result;
}

template <int R>
CentreOf<R> centre_of_track(const Anchor& anchor, const Extent& extent, const Heading& axis, const Scalar& shown,
                            const estimators::Cartesian& estimate) {
  if (anchor.point == SeenPoint::kCentre)
    return {{estimate.x.head<R>(), estimate.p.topLeftCorner<R, R>()}, facing_of(estimate, axis)};
  const Turn turn = turn_of(estimate, axis);
  const Facing facing = facing_at_centre(anchor, extent, axis, estimate, turn);
  const Direction direction = direction_of(axis, facing);
  const bool of_silhouette = anchor.point == SeenPoint::kSilhouette;
  const double weight = of_silhouette ? direction.weight(kBehindSilhouette) : 1.0;
  const std::optional<Located> centre =
      weight > 0.0 ? centre_of(anchor, estimate.x.head<2>(), {extent.size, direction.heading}) : std::nullopt;
  if (!centre) return {behind<R>(anchor, extent, shown, turn, estimate), facing};
  linear::Gaussian<R> result = turned<R>(*centre, extent, axis, facing, turn, estimate);
  if (weight < 1.0) result = mixture<R>(result, weight, behind<R>(anchor, extent, shown, turn, estimate));
  return {result, facing};
}

linear::Vector<2> place_of(const sensors::Observation& z, const sensors::Mounting& mounting) {
  if (z.kind == sensors::ObservationKind::kPosition) return z.z.head<2>();
  const double bearing = z.z(1) + mounting.yaw;
  return mounting.position + z.z(0) * linear::Vector<2>(std::cos(bearing), std::sin(bearing));
}

// Without a heading, a silhouette and a centre have a distance along the line of sight. Other points may be anywhere on the
// outline.
void put_unknown(Distance& distance, const Track& track, const linear::Vector<2>& at) {
  const Anchor& anchor = track.anchor;
  const bool of_silhouette = anchor.point == SeenPoint::kSilhouette,
             to_silhouette = distance.to.point == SeenPoint::kSilhouette;
  const bool behind = of_silhouette && distance.to.point == SeenPoint::kCentre;
  const bool before = anchor.point == SeenPoint::kCentre && to_silhouette;
  if (!behind && !before && !(of_silhouette && to_silhouette)) {
    distance.constant = 0.25 * track.extent.size.squaredNorm() * linear::Matrix<2>::Identity();
    return;
  }
  const linear::Vector<2> from = behind ? anchor.from : distance.to.from, sight = sight_to(at, from);
  const Behind centre = behind_of(track.extent, track.shown, (at - from).norm());
  distance.between = (behind ? 1.0 : before ? -1.0 : 0.0) * centre.depth * sight;
  distance.constant = covariance_of(centre, sight);
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
  return result;
}

// The object's axes, along and across.
linear::Matrix<2> axes_of(const Distance& distance) {
  linear::Matrix<2> axes;
  axes << distance.axis, linear::Vector<2>(-distance.axis.y(), distance.axis.x());
  return axes;
}

}  // namespace

std::optional<Distance> distance_to(const Track& track, const estimators::Estimator& estimator,
                                    const sensors::Observation& z, const sensors::Mounting& mounting) {
  const Anchor& anchor = track.anchor;
  const bool has_sides = z.seen != SeenPoint::kCentre && z.seen != SeenPoint::kSilhouette;
  Distance distance;
  Direction direction{z.heading, z.sigma_heading};
  if (has_sides && track.heading.known) direction.heading = track.heading.value;
  distance.to = anchor_of(z.seen, place_of(z, mounting), direction.heading, mounting.position);
  if (z.seen == SeenPoint::kSilhouette) distance.to.sensor = z.sensor;
  if (distance.to == anchor) return std::nullopt;

  const estimators::Cartesian estimate = estimator.cartesian(track.estimate);
  const linear::Vector<2> at = estimate.x.head<2>();
  const Turn turn = turn_of(estimate, track.heading);
  if (!z.has_heading || track.heading.known)
    direction = direction_of(track.heading, facing_at_centre(anchor, track.extent, track.heading, estimate, turn));
  distance.axis << std::cos(direction.heading), std::sin(direction.heading);
  distance.velocity = estimate.x.segment<2>(2);
  const bool with_silhouette = anchor.point == SeenPoint::kSilhouette || z.seen == SeenPoint::kSilhouette;
  const double weight = direction.weight(with_silhouette ? kBehindSilhouette : kOfSides);
  const std::optional<Located> point =
      weight > 0.0 ? point_of(distance.to, anchor, at, {track.extent.size, direction.heading}) : std::nullopt;
  if (!point || weight < 1.0) put_unknown(distance, track, at);
  if (!point) return distance;
  const linear::Vector<2> by_heading = point->by_box.col(2), by_sigma = by_heading * direction.sigma;
  const linear::Matrix<2> by_size = point->by_box.leftCols<2>();
  const linear::Vector<2> apart = point->at - at - distance.between;
  distance.constant = weight * by_size * track.extent.covariance * by_size.transpose() +
                      (1.0 - weight) * distance.constant + weight * (1.0 - weight) * apart * apart.transpose();
  linear::symmetrise<2>(distance.constant);
  distance.between += weight * apart;
  distance.by_size = weight * by_size;
  distance.noise = weight * by_sigma * by_sigma.transpose();
  distance.swing = weight * turn.rate * by_heading;
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

void learn_size(Extent& extent, const sensors::Observation& z, const Distance& distance,
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

Centre centred(const Anchor& anchor, const Extent& extent, const Heading& axis, const Scalar& shown,
               const estimators::Cartesian& estimate) {
  return centre_of_track<6>(anchor, extent, axis, shown, estimate);
}

CentrePosition centre_position(const Track& track, const estimators::Cartesian& estimate) {
  return centre_of_track<2>(track.anchor, track.extent, track.heading, track.shown, estimate);
}

}  // namespace ttf::fusion::tracks
