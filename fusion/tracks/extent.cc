#include "fusion/tracks/extent.h"

#include <algorithm>
#include <cmath>

namespace ttf::fusion::tracks {
namespace {

constexpr double kWorstAspectSigma = 0.3;  // [rad]
constexpr double kCompatible = 3.0;        // sigmas
constexpr double kFlattest = 4.0;          // sigmas of the aspect

// Updates by one measured combination h' (length, width) with innovation nu and variance `white` + `repeating`,
// in Joseph form.
void correct(Extent& extent, const Eigen::Vector2d& h, double nu, double white, double repeating) {
  const Eigen::Vector2d ph = extent.covariance * h;
  const double before = h.dot(ph);
  if (before <= repeating) return;
  const double variance = std::max(white + repeating, before * repeating / (before - repeating));
  const Eigen::Vector2d gain = ph / (before + variance);
  const Eigen::Matrix2d a = Eigen::Matrix2d::Identity() - gain * h.transpose();
  extent.size += gain * nu;
  extent.covariance = (a * extent.covariance * a.transpose() + variance * gain * gain.transpose()).eval();
}

void correct_directly(Extent& extent, const Eigen::Vector2d& h, double measured, double sigma) {
  const double half = 0.5 * sigma * sigma;
  correct(extent, h, measured - h.dot(extent.size), half, half);
}

}  // namespace

bool Extent::knows_length() const { return covariance(0, 0) <= 0.25 * kTypicalLengthSigma * kTypicalLengthSigma; }
bool Extent::knows_width() const { return covariance(1, 1) <= 0.25 * kTypicalWidthSigma * kTypicalWidthSigma; }

void predict(Extent& extent, double noise, double dt) {
  extent.covariance(0, 0) += noise * dt;
  extent.covariance(1, 1) += noise * dt;
}

void correct_length(Extent& extent, double length, double sigma) {
  correct_directly(extent, Eigen::Vector2d::UnitX(), length, sigma);
}

void correct_width(Extent& extent, double width, double sigma) {
  correct_directly(extent, Eigen::Vector2d::UnitY(), width, sigma);
}

Subtended subtended(double range, double aspect, const Eigen::Vector2d& size) {
  // Coordinates along and across the line of sight; the corners' azimuths count from it.
  const double c = std::cos(aspect), s = std::sin(aspect);
  Subtended result;
  double low = 0.0, high = 0.0;
  Eigen::Vector2d low_by = Eigen::Vector2d::Zero(), high_by = Eigen::Vector2d::Zero();
  for (const double u : {0.5, -0.5})
    for (const double v : {0.5, -0.5}) {
      const double along = range + c * u * size(0) - s * v * size(1), across = s * u * size(0) + c * v * size(1);
      if (along <= 0.0) return {};
      const double azimuth = std::atan2(across, along), squared = along * along + across * across;
      const Eigen::Vector2d by((along * s * u - across * c * u) / squared, (along * c * v + across * s * v) / squared);
      if (azimuth < low) {
        low = azimuth;
        low_by = by;
      }
      if (azimuth > high) {
        high = azimuth;
        high_by = by;
      }
    }
  result.angle = high - low;
  result.by_size = high_by - low_by;
  return result;
}

void correct_span(Extent& extent, const Aspect& aspect, double span, double sigma) {
  if (aspect.sigma_angle > kWorstAspectSigma) return;
  const Subtended expected = subtended(aspect.range, aspect.angle, extent.size);
  if (expected.angle <= 0.0) return;
  // Seen end on, the span has a kink: it is smallest there and grows to either side. So the larger difference
  // stands for the derivative.
  const double left = subtended(aspect.range, aspect.angle + aspect.sigma_angle, extent.size).angle,
               right = subtended(aspect.range, aspect.angle - aspect.sigma_angle, extent.size).angle;
  const double by_aspect = std::max(std::abs(left - expected.angle), std::abs(right - expected.angle));
  const double by_range = expected.angle * aspect.sigma_range / aspect.range;
  double repeating = by_aspect * by_aspect + by_range * by_range;
  const double before = expected.by_size.dot(extent.covariance * expected.by_size);
  const double nu = span - expected.angle;
  if (nu * nu > kCompatible * kCompatible * (before + sigma * sigma + repeating)) return;
  Eigen::Vector2d told = expected.by_size;
  const double foreshortening[] = {std::abs(std::sin(aspect.angle)), std::abs(std::cos(aspect.angle))};
  for (Eigen::Index k = 0; k < 2; ++k)
    if (foreshortening[k] < kFlattest * aspect.sigma_angle) {
      repeating += told(k) * told(k) * extent.covariance(k, k);
      told(k) = 0.0;
    }
  correct(extent, told, nu, sigma * sigma, repeating);
}

}  // namespace ttf::fusion::tracks
