#include "fusion/tracks/body/reading.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "fusion/motion/angles.h"

namespace ttf::fusion::tracks::body {
namespace {

using sensors::SeenPoint;

constexpr double kQuarter = 0.5 * std::numbers::pi;
constexpr double kFarthest = 5.0;  // standard deviations

SeenPoint read_otherwise(SeenPoint seen) {
  switch (seen) {
    case SeenPoint::kEnd: return SeenPoint::kSide;
    case SeenPoint::kSide: return SeenPoint::kEnd;
    case SeenPoint::kCentre:
    case SeenPoint::kCorner:
    case SeenPoint::kSilhouette:
    case SeenPoint::kRightmost:
    case SeenPoint::kLeftmost: return seen;
  }
  return seen;
}

double log_of_square(double square, double variance) { return -0.5 * (square / variance + std::log(variance)); }

double log_of_side(double measured, double sigma, double expected, double expected_variance) {
  const double variance = expected_variance + sigma * sigma, nu = measured - expected;
  return log_of_square(std::min(nu * nu, kFarthest * kFarthest * variance), variance);
}

// The logarithm of the density of the measured sides, of which the length is the body's `side` and the width its other one.
double log_of_sides(const Extent& extent, const sensors::Observation& z, Eigen::Index side) {
  double sum = 0.0;
  if (z.has_length) sum += log_of_side(z.length, z.sigma_length, extent.size(side), extent.covariance(side, side));
  const Eigen::Index other = 1 - side;
  if (z.has_width) sum += log_of_side(z.width, z.sigma_width, extent.size(other), extent.covariance(other, other));
  return sum;
}

}  // namespace

sensors::Observation read_otherwise(const sensors::Observation& observation) {
  sensors::Observation other = observation;
  other.seen = read_otherwise(observation.seen);
  other.heading = motion::to_half_turn(observation.heading + kQuarter);
  std::swap(other.has_length, other.has_width);
  std::swap(other.length, other.width);
  std::swap(other.sigma_length, other.sigma_width);
  return other;
}

// With u and n the old axes, the new ones are n and -u.
Anchor read_otherwise(const Anchor& anchor) {
  Anchor other = anchor;
  other.point = read_otherwise(anchor.point);
  other.along = anchor.across;
  other.across = static_cast<signed char>(-anchor.along);
  return other;
}

Heading read_otherwise(const Heading& heading) {
  Heading other = heading;
  other.value = motion::to_half_turn(heading.value + kQuarter);
  other.front = 0;
  return other;
}

Direction axis_of(const Body& body, const estimators::Estimator& estimator) {
  if (body.heading.known) return {body.heading.value, std::sqrt(body.heading.variance)};
  const linear::Gaussian<2> velocity = estimators::velocity_of(estimator.cartesian(body.estimate));
  const Facing course = facing_of(velocity, body.heading);
  const double slip = kSlip * kSlip / std::max(kSlip * kSlip, velocity.x.squaredNorm()) + kSlipOfSpeed * kSlipOfSpeed;
  return {course.heading, std::sqrt(course.sigma * course.sigma + slip)};
}

bool reads_otherwise(const Direction& axis, const Extent& extent, const sensors::Observation& z) {
  if (!z.has_heading || z.seen == SeenPoint::kCentre) return false;
  const double off = std::abs(motion::to_half_turn(nearest_half_turn(z.heading, axis.heading) - axis.heading));
  const double other_off = kQuarter - off, variance = axis.sigma * axis.sigma + z.sigma_heading * z.sigma_heading;
  return log_of_square(other_off * other_off, variance) + log_of_sides(extent, z, 1) >
         log_of_square(off * off, variance) + log_of_sides(extent, z, 0);
}

}  // namespace ttf::fusion::tracks::body
