#include "fusion/tracks/body/returns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "fusion/motion/angles.h"
#include "fusion/tracks/body/centre.h"

namespace ttf::fusion::tracks::body {
namespace {

constexpr double kEighth = 0.25 * std::numbers::pi;
// A heading beyond this standard deviation [rad] is unknown.
constexpr double kUnknownHeading = 0.7;

linear::Vector<2> on_its_left(const linear::Vector<2>& a) { return {-a.y(), a.x()}; }

// The distance of the box along a direction, by the slab method; infinite where the ray passes it.
double range_of(const SeenBox& outline, const linear::Vector<2>& axis, const linear::Vector<2>& sight) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  double enter = 0.0, leave = kNever;
  for (int side = 0; side < 2; ++side) {
    const linear::Vector<2> along = side == 0 ? axis : on_its_left(axis);
    const double towards = along.dot(sight), middle = along.dot(outline.centre), half = 0.5 * outline.box.size(side);
    if (std::abs(towards) < 1e-12) {
      if (std::abs(middle) > half) return kNever;
      continue;
    }
    const double one = (middle - half) / towards, other = (middle + half) / towards;
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  return enter > leave || enter <= 0.0 ? kNever : enter;
}

struct HeadedBox {
  SeenBox box;
  bool headed = false;
  double sigma = 0.0;  // the heading's [rad]
};
HeadedBox seen_box_of(const Body& body, const estimators::Estimator& estimator, const sensors::Mounting& mounting) {
  const estimators::Cartesian estimate = estimator.cartesian(body.estimate);
  const CentrePosition centre = centre_position(body, estimate);
  HeadedBox seen;
  seen.headed = centre.facing.sigma <= kUnknownHeading;
  seen.sigma = centre.facing.sigma;
  SeenBox& outline = seen.box;
  outline.centre = centre.estimate.x - mounting.position;
  outline.box.size = body.extent.size;
  const double sight = std::atan2(outline.centre.y(), outline.centre.x());
  outline.box.heading = seen.headed ? centre.facing.heading : sight + kEighth;
  outline.turn_rate = seen.headed && body.heading.known ? body.heading.rate : 0.0;
  outline.velocity = estimate.x.segment<2>(2) - mounting.velocity +
                     outline.turn_rate * on_its_left(linear::Vector<2>(centre.estimate.x - estimate.x.head<2>()));
  return seen;
}

}  // namespace

linear::Matrix<3> spread_of(const SeenBox& outline) {
  constexpr int kRays = 16;
  const linear::Vector<2> axis(std::cos(outline.box.heading), std::sin(outline.box.heading));
  const double middle = std::atan2(outline.centre.y(), outline.centre.x());
  double low = 0.0, high = 0.0;
  for (const double a : {-0.5, 0.5})
    for (const double b : {-0.5, 0.5}) {
      const linear::Vector<2> corner =
          outline.centre + a * outline.box.size(0) * axis + b * outline.box.size(1) * on_its_left(axis);
      const double off = motion::to_half_turn(std::atan2(corner.y(), corner.x()) - middle);
      if (std::abs(off) > 0.5 * std::numbers::pi) return linear::Matrix<3>::Zero();
      low = std::min(low, off);
      high = std::max(high, off);
    }
  std::array<linear::Vector<3>, kRays> points;
  int hits = 0;
  linear::Vector<3> mean = linear::Vector<3>::Zero();
  // Each direction is the one before, turned by a step: sines take long.
  const double step = (high - low) / kRays, first = middle + low + 0.5 * step, c = std::cos(step), s = std::sin(step);
  linear::Vector<2> sight(std::cos(first), std::sin(first));
  for (int k = 0; k < kRays;
       ++k, sight = linear::Vector<2>(c * sight.x() - s * sight.y(), s * sight.x() + c * sight.y())) {
    const double off = low + (k + 0.5) * step;
    const double range = range_of(outline, axis, sight);
    if (!std::isfinite(range)) continue;
    const linear::Vector<2> velocity =
        outline.velocity + outline.turn_rate * on_its_left(linear::Vector<2>(range * sight - outline.centre));
    linear::Vector<3>& point = points[static_cast<std::size_t>(hits++)];
    point << range, off, sight.dot(velocity);
    mean += point;
  }
  linear::Matrix<3> spread = linear::Matrix<3>::Zero();
  if (hits == 0) return spread;
  mean /= hits;
  for (int k = 0; k < hits; ++k) {
    const linear::Vector<3> apart = points[static_cast<std::size_t>(k)] - mean;
    spread += apart * apart.transpose() / hits;
  }
  return spread;
}

SeenBox seen_box(const Body& body, const estimators::Estimator& estimator, const sensors::Mounting& mounting) {
  return seen_box_of(body, estimator, mounting).box;
}

linear::Matrix<3> spread_of(const Body& body, const estimators::Estimator& estimator,
                            const sensors::Mounting& mounting) {
  auto [outline, headed, sigma] = seen_box_of(body, estimator, mounting);
  if (!headed) return spread_of(outline);
  // Three headings have the moments of all of them up to the fifth (Gauss and Hermite).
  const double heading = outline.box.heading, step = std::numbers::sqrt3 * sigma;
  linear::Matrix<3> spread = 2.0 / 3.0 * spread_of(outline);
  for (const double turned : {-step, step}) {
    outline.box.heading = heading + turned;
    spread += spread_of(outline) / 6.0;
  }
  return spread;
}

sensors::Observation with_spread(const sensors::Observation& observation, const linear::Matrix<3>& spread) {
  sensors::Observation result = observation;
  if (observation.returns > 0) result.r += spread / observation.returns;
  return result;
}

sensors::Observation with_spread(const sensors::Observation& observation, const Body& body,
                                 const estimators::Estimator& estimator, const sensors::Mounting& mounting) {
  if (observation.returns == 0) return observation;
  return with_spread(observation, spread_of(body, estimator, mounting));
}

sensors::Observation with_spread(const sensors::Observation& observation, const Extent& extent) {
  if (observation.returns == 0) return observation;
  SeenBox outline;
  outline.centre << observation.z(0), 0.0;  // to the spread, the bearing is no matter
  outline.box = {extent.size, kEighth};
  return with_spread(observation, spread_of(outline));
}

const linear::Matrix<3>& Spreads::of(std::size_t index, const Body& body, const estimators::Estimator& estimator,
                                     const sensors::Mounting& mounting) {
  OfTrack& known = of_track_[index];
  if (known.list != list_ || known.position != mounting.position || known.velocity != mounting.velocity)
    known = {list_, mounting.position, mounting.velocity, spread_of(body, estimator, mounting)};
  return known.spread;
}

}  // namespace ttf::fusion::tracks::body
