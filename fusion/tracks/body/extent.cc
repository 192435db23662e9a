#include "fusion/tracks/body/extent.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ttf::fusion::tracks::body {
namespace {

constexpr double kWorstAspectSigma = 0.3;  // [rad]
constexpr double kCompatible = 3.0;        // sigmas
constexpr double kFlattest = 4.0;          // sigmas of the aspect

void correct_directly(Extent& extent, const Eigen::Vector2d& h, double measured, double sigma) {
  constexpr double kRepeating = 0.8;
  const double variance = sigma * sigma;
  correct_combination(extent, h, measured - h.dot(extent.size), (1.0 - kRepeating) * variance, kRepeating * variance);
}

// A corner of the outline: along and across the line of sight. u and v are 0.5 or -0.5.
struct Corner {
  double u = 0.0, v = 0.0, along = 1.0, across = 0.0;
};

// The corners that subtend the angle, for an aspect with this cosine and sine.
struct Outermost {
  double c, s;
  Corner low, high;

  double angle() const { return std::atan2(high.across, high.along) - std::atan2(low.across, low.along); }
  // The derivatives of a corner's azimuth by length and width.
  Eigen::Vector2d by_size(const Corner& at) const {
    const double squared = at.along * at.along + at.across * at.across;
    return {(at.along * s * at.u - at.across * c * at.u) / squared,
            (at.along * c * at.v + at.across * s * at.v) / squared};
  }
};

// The tangents of the corners' azimuths, counted from the line of sight, tell the outermost ones. Returns no value if a
// corner is not in front of the sensor.
std::optional<Outermost> outermost(double range, double aspect, const Eigen::Vector2d& size) {
  Outermost found{std::cos(aspect), std::sin(aspect), {}, {}};
  double low_tangent = 0.0, high_tangent = 0.0;
  for (const double u : {0.5, -0.5})
    for (const double v : {0.5, -0.5}) {
      const Corner corner{u, v, range + found.c * u * size(0) - found.s * v * size(1),
                          found.s * u * size(0) + found.c * v * size(1)};
      if (corner.along <= 0.0) return std::nullopt;
      const double tangent = corner.across / corner.along;
      if (tangent < low_tangent) {
        found.low = corner;
        low_tangent = tangent;
      }
      if (tangent > high_tangent) {
        found.high = corner;
        high_tangent = tangent;
      }
    }
  return found;
}

// The subtended angle [rad], zero if the outline surrounds the sensor.
double angle_subtended(double range, double aspect, const Eigen::Vector2d& size) {
  const std::optional<Outermost> corners = outermost(range, aspect, size);
  return corners ? corners->angle() : 0.0;
}

// The span that an extent lets one expect, with its variance by the sizes and that of the errors that repeat.
struct ExpectedSpan : Subtended {
  double variance, repeating;
};

// Returns no value if the aspect is unknown, or if the outline surrounds the sensor.
std::optional<ExpectedSpan> expected_span(const Extent& extent, const Aspect& aspect) {
  if (aspect.sigma_angle > kWorstAspectSigma) return std::nullopt;
  const Subtended expected = subtended(aspect.range, aspect.angle, extent.size);
  if (expected.angle <= 0.0) return std::nullopt;
  // Seen end on, the span has a kink: it is smallest there and grows to either side. So the larger difference
  // stands for the derivative.
  const double left = angle_subtended(aspect.range, aspect.angle + aspect.sigma_angle, extent.size),
               right = angle_subtended(aspect.range, aspect.angle - aspect.sigma_angle, extent.size);
  const double by_aspect = std::max(std::abs(left - expected.angle), std::abs(right - expected.angle));
  const double by_range = expected.angle * aspect.sigma_range / aspect.range;
  return ExpectedSpan{expected, expected.by_size.dot(extent.covariance * expected.by_size),
                      by_aspect * by_aspect + by_range * by_range};
}

}  // namespace

void keep_positive(Extent& extent) {
  constexpr double kSmallest = 0.1;  // [m]
  for (Eigen::Index k = 0; k < 2; ++k) {
    if (extent.size(k) >= kSmallest) continue;
    const double step = kSmallest - extent.size(k), variance = extent.covariance(k, k);
    const double other = variance > 0.0 ? extent.covariance(1 - k, k) / variance : 0.0;
    extent.size(1 - k) = std::max(kSmallest, extent.size(1 - k) + other * step);
    extent.size(k) = kSmallest;
  }
}

Extent::Extent(const config::Sizes& prior) : size(prior.length, prior.width) {
  const double cross = prior.correlation * prior.length_sigma * prior.width_sigma;
  covariance << prior.length_sigma * prior.length_sigma, cross, cross, prior.width_sigma * prior.width_sigma;
  prior_variances = covariance.diagonal();
}

void predict(Extent& extent, double noise, double dt) {
  extent.covariance(0, 0) += noise * dt;
  extent.covariance(1, 1) += noise * dt;
}

// In Joseph form.
void correct_combination(Extent& extent, const Eigen::Vector2d& h, double nu, double white, double repeating) {
  const Eigen::Vector2d ph = extent.covariance * h;
  const double before = h.dot(ph);
  if (before <= repeating) return;
  const double variance = std::max(white + repeating, before * repeating / (before - repeating));
  const Eigen::Vector2d gain = ph / (before + variance);
  const Eigen::Matrix2d a = Eigen::Matrix2d::Identity() - gain * h.transpose();
  extent.size += gain * nu;
  extent.covariance = (a * extent.covariance * a.transpose() + variance * gain * gain.transpose()).eval();
  keep_positive(extent);
}

void correct_length(Extent& extent, double length, double sigma) {
  correct_directly(extent, Eigen::Vector2d::UnitX(), length, sigma);
}

void correct_width(Extent& extent, double width, double sigma) {
  correct_directly(extent, Eigen::Vector2d::UnitY(), width, sigma);
}

Subtended subtended(double range, double aspect, const Eigen::Vector2d& size) {
  const std::optional<Outermost> corners = outermost(range, aspect, size);
  if (!corners) return {};
  return {corners->angle(), corners->by_size(corners->high) - corners->by_size(corners->low)};
}

std::optional<double> log_density_of_span(const Extent& extent, const Aspect& aspect, double span, double sigma) {
  const std::optional<ExpectedSpan> expected = expected_span(extent, aspect);
  if (!expected) return std::nullopt;
  const double variance = expected->variance + sigma * sigma + expected->repeating, nu = span - expected->angle;
  return -0.5 * (nu * nu / variance + std::log(variance));
}

void correct_span(Extent& extent, const Aspect& aspect, double span, double sigma) {
  const std::optional<ExpectedSpan> expected = expected_span(extent, aspect);
  if (!expected) return;
  double repeating = expected->repeating;
  const double nu = span - expected->angle;
  if (nu * nu > kCompatible * kCompatible * (expected->variance + sigma * sigma + repeating)) return;
  Eigen::Vector2d by_size = expected->by_size;
  const double foreshortening[] = {std::abs(std::sin(aspect.angle)), std::abs(std::cos(aspect.angle))};
  for (Eigen::Index k = 0; k < 2; ++k)
    if (foreshortening[k] < kFlattest * aspect.sigma_angle) {
      repeating += by_size(k) * by_size(k) * extent.covariance(k, k);
      by_size(k) = 0.0;
    }
  correct_combination(extent, by_size, nu, sigma * sigma, repeating);
}

}  // namespace ttf::fusion::tracks::body
