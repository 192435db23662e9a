#include "fusion/tracks/body/centre.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fusion/motion/kernels.h"
#include "fusion/tracks/body/behind.h"
#include "fusion/tracks/body/turn.h"

namespace ttf::fusion::tracks::body {
namespace {

using sensors::SeenPoint;

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

// The first R of a centre's components are functions of the first K of its anchor's: all six, or four if the model has no
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

}  // namespace

Centre centred(const Anchor& anchor, const Extent& extent, const Heading& axis, const Scalar& shown,
               const estimators::Cartesian& estimate) {
  return centre_of_track<6>(anchor, extent, axis, shown, estimate);
}

CentrePosition centre_position(const Body& body, const estimators::Cartesian& estimate) {
  return centre_of_track<2>(body.anchor, body.extent, body.heading, body.shown, estimate);
}

std::optional<Aspect> aspect_of(const Body& body, const estimators::Cartesian& estimate,
                                const linear::Vector<2>& from) {
  const CentrePosition now = centre_position(body, estimate);
  const double x = now.estimate.x(0) - from.x(), y = now.estimate.x(1) - from.y(), range = std::hypot(x, y);
  if (range <= 0.0) return std::nullopt;
  const linear::Vector<2> sight(x / range, y / range);
  return Aspect{range, std::sqrt(sight.dot(now.estimate.p * sight)),
                motion::to_half_turn(now.facing.heading - std::atan2(y, x)), now.facing.sigma};
}

}  // namespace ttf::fusion::tracks::body
