#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "sensors/laser/outline_fit.h"
#include "sensors/laser/range_models.h"
#include "sensors/laser/scatter.h"

namespace ttf::sensors::laser {
namespace {

constexpr double kPi = std::numbers::pi;
// The corner may lie between so many beams beside the likeliest ones.
constexpr std::size_t kReach = 3, kPlaces = 2 * kReach + 1;

// A place of the corner, between two beams. Starts with the returns' distances to their faces.
struct Place {
  double squares = std::numeric_limits<double>::infinity();
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  std::size_t returns_right = 0;
};

// Fits faces at a right angle to the returns on either side. Unusable unless it is a corner turned to the sensor.
Place place_between(const Moments& right, const Moments& left, const PlanePoint& origin) {
  Scatter scatter;
  scatter.add(right, false);
  scatter.add(left, true);
  const Eigen::Vector2d right_mean(origin.x + right.x / right.n, origin.y + right.y / right.n);
  const Eigen::Vector2d left_mean(origin.x + left.x / left.n, origin.y + left.y / left.n);
  double angle = scatter.minor_axis();
  if (direction(angle).dot(right_mean) < 0.0) angle += kPi;
  const Eigen::Vector2d n = direction(angle), m(n.y(), -n.x());
  const Eigen::Vector2d corner = n * n.dot(right_mean) + m * m.dot(left_mean);
  const Eigen::Vector3d start(corner.x(), corner.y(), angle);
  // A corner, not a notch: the faces go away from it to their own sides.
  if (!CornerModel(start).usable() || cross(corner, right_mean) >= 0.0 || cross(corner, left_mean) <= 0.0) return {};
  return {scatter.least(), start, static_cast<std::size_t>(right.n)};
}

using Places = std::array<Place, kPlaces>;

// Returns the best place and those around it.
Places best_places(std::span<const PlanePoint> points) {
  const PlanePoint& origin = points.front();
  Moments all, right;
  for (const PlanePoint& point : points) all.add(point.x - origin.x, point.y - origin.y);
  Places places;
  std::array<Place, kReach> before;
  double least = std::numeric_limits<double>::infinity();
  std::size_t following = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    right.add(points[i].x - origin.x, points[i].y - origin.y);
    if (points[i + 1].azimuth == points[i].azimuth) continue;
    const Place place = place_between(right, all - right, origin);
    if (place.squares < least) {
      least = place.squares;
      places = {};
      std::copy(before.begin(), before.end(), places.begin());
      places[kReach] = place;
      following = kReach;
    } else if (following > 0) {
      places[kPlaces - following--] = place;
    }
    std::rotate(before.begin(), before.begin() + 1, before.end());
    before.back() = place;
  }
  return places;
}

// The parameters of a corner at one place. `share` is the logarithm of the place's probability, up to a constant.
struct Hypothesis {
  Eigen::Vector3d mean;
  Eigen::Matrix3d covariance;
  double share;
};

double density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * kPi); }

// Cuts a Gaussian to bearings of the corner between two beams. Returns the probability of the rest. Adds the cost of its
// nearest bearing to `squares`.
double cut(Eigen::Vector3d& mean, Eigen::Matrix3d& covariance, double from, double to, double variance,
           double& squares) {
  const Eigen::Vector2d c = mean.head<2>();
  const Eigen::Vector3d by(-c.y() / c.squaredNorm(), c.x() / c.squaredNorm(), 0.0);
  const Eigen::Vector3d moved = covariance * by;
  const double spread = by.dot(moved), sigma = std::sqrt(spread);
  const double bearing = from + std::remainder(std::atan2(c.y(), c.x()) - from, 2.0 * kPi);
  const double low = (from - bearing) / sigma, high = (to - bearing) / sigma;
  const double outside = std::max({0.0, low, -high});
  squares += outside * outside * variance;
  const double inside = 0.5 * (std::erfc(-high / std::sqrt(2.0)) - std::erfc(-low / std::sqrt(2.0)));
  constexpr double kLeast = 1e-9;
  if (!(inside > kLeast)) return 0.0;
  const double shift = (density(low) - density(high)) / inside;
  const double rest = 1.0 + (low * density(low) - high * density(high)) / inside - shift * shift;
  mean += moved * (sigma * shift / spread);
  covariance -= moved * moved.transpose() * ((1.0 - std::clamp(rest, 0.0, 1.0)) / spread);
  return inside;
}

double log_volume(const Eigen::Matrix3d& covariance) {
  return 0.5 * std::log(std::max(std::numeric_limits<double>::min(), covariance.determinant()));
}

// The corner is beyond the last beam, to the left or to the right: all returns are of the other face. Its bearing is
// uniform up to the next beam.
Hypothesis beyond(const FaceFit& face, double last, double step, bool left, double variance) {
  const double bearing = last + (left ? 0.5 : -0.5) * step;
  const Eigen::Vector2d n = direction(face.normal), u = direction(bearing), t(-n.y(), n.x());
  const double steep = std::max(kFlattestBeam, n.dot(u)), range = face.distance / steep;
  Eigen::Matrix3d by = Eigen::Matrix3d::Zero();  // distance, normal, bearing
  by.col(0).head<2>() = u / steep;
  by.col(1).head<2>() = -u * (range * cross(n, u) / steep);
  by(2, 1) = 1.0;
  by.col(2).head<2>() = t * (range / steep);
  Eigen::Matrix3d errors = Eigen::Matrix3d::Zero();
  errors.topLeftCorner<2, 2>() = face.covariance;
  errors(2, 2) = step * step / 12.0;
  Hypothesis place;
  place.mean << range * u, face.normal + (left ? 0.0 : 0.5 * kPi);
  place.covariance = by * errors * by.transpose();
  // A uniform distribution has this volume over that of the Gaussian with its variance.
  place.share = -0.5 * face.squares / variance + log_volume(place.covariance) + 0.5 * std::log(6.0 / kPi);
  return place;
}

// Fills in how many returns are right of the gaps between beams around the corner, nearest beams first in azimuth.
std::size_t splits_around(const Eigen::Vector2d& corner, std::span<const PlanePoint> points,
                          std::array<std::size_t, kPlaces>& splits) {
  std::size_t middle = 0;
  while (middle < points.size() && corner.x() * points[middle].y - corner.y() * points[middle].x <= 0.0) ++middle;
  std::size_t from = middle, count = 0;
  const auto is_split = [&](std::size_t i) {
    return i > 0 && i < points.size() && points[i].azimuth != points[i - 1].azimuth;
  };
  for (std::size_t passed = 0; from > 0 && passed <= kReach; --from) passed += is_split(from);
  for (std::size_t i = from + 1; i < points.size() && count < kPlaces; ++i)
    if (is_split(i)) splits[count++] = i;
  return count;
}

CornerFit merged(std::span<const Hypothesis> places) {
  double most = -std::numeric_limits<double>::infinity(), total = 0.0;
  for (const Hypothesis& place : places) most = std::max(most, place.share);
  const auto difference = [&](const Hypothesis& place) {
    Eigen::Vector3d d = place.mean - places.front().mean;
    d(2) = std::remainder(d(2), 2.0 * kPi);
    return d;
  };
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Hypothesis& place : places) {
    const double weight = std::exp(place.share - most);
    total += weight;
    mean += weight * difference(place);
  }
  mean /= total;
  CornerFit fit;
  for (const Hypothesis& place : places) {
    const Eigen::Vector3d d = difference(place) - mean;
    fit.covariance += std::exp(place.share - most) / total * (place.covariance + d * d.transpose());
  }
  mean += places.front().mean;
  fit.corner = mean.head<2>();
  fit.normal = std::remainder(mean(2), 2.0 * kPi);
  return fit;
}

}  // namespace

std::optional<CornerFit> fit_corner(std::span<const PlanePoint> points, double noise, double step,
                                    const std::optional<FaceFit>& face) {
  // The best corner, wherever it moves in the iteration.
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  Eigen::Matrix3d best_errors = Eigen::Matrix3d::Zero();
  double lowest = std::numeric_limits<double>::infinity();
  const Places likely = best_places(points);
  for (const std::size_t start : {kReach, std::size_t{0}, kPlaces - 1}) {
    const Place& place = likely[start];
    if (!std::isfinite(place.squares)) continue;
    Eigen::Vector3d at = place.start;
    Eigen::Matrix3d errors;
    const auto found = minimise<CornerModel>(points, at, errors);
    if (!found || *found >= lowest) continue;
    lowest = *found;
    best = at;
    best_errors = errors;
  }
  if (!std::isfinite(lowest)) return std::nullopt;
  const double variance = variance_of(lowest, points.size(), CornerModel::kSize, noise);
  std::array<Hypothesis, kPlaces + 2> hypotheses;
  std::size_t count = 0;
  double squares = std::numeric_limits<double>::infinity();
  std::array<std::size_t, kPlaces> splits;
  const std::size_t places = splits_around(best.head<2>(), points, splits);
  for (std::size_t k = 0; k < places; ++k) {
    Hypothesis& at = hypotheses[count];
    at.mean = best;
    const auto found = minimise<CornerModel>(points, at.mean, at.covariance, splits[k]);
    if (!found) continue;
    at.covariance *= variance;
    at.share = -0.5 * *found / variance + log_volume(at.covariance);
    double least = *found;
    const double inside =
        cut(at.mean, at.covariance, points[splits[k] - 1].azimuth, points[splits[k]].azimuth, variance, least);
    if (inside == 0.0) continue;
    at.share += std::log(inside);
    squares = std::min(squares, least);
    ++count;
  }
  if (count == 0) {  // an outline that no corner fits well
    hypotheses[count++] = {best, variance * best_errors, 0.0};
    squares = lowest;
  } else if (face) {
    hypotheses[count++] = beyond(*face, points.back().azimuth, step, true, variance);
    hypotheses[count++] = beyond(*face, points.front().azimuth, step, false, variance);
  }
  CornerFit fit = merged(std::span(hypotheses).first(count));
  fit.squares = squares;
  fit.variance = variance;
  return fit;
}

}  // namespace ttf::sensors::laser
