#include "fusion/tracks/body/turn.h"

#include <algorithm>
#include <cmath>

namespace ttf::fusion::tracks::body {
namespace {

using sensors::SeenPoint;

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

}  // namespace

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

}  // namespace ttf::fusion::tracks::body
