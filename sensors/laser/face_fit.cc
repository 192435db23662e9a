#include <cmath>
#include <numbers>

#include "sensors/laser/outline_fit.h"
#include "sensors/laser/range_models.h"
#include "sensors/laser/scatter.h"

namespace ttf::sensors::laser {

std::optional<FaceFit> fit_face(std::span<const PlanePoint> points, double noise) {
  const PlanePoint& origin = points.front();
  Moments all;
  for (const PlanePoint& point : points) all.add(point.x - origin.x, point.y - origin.y);
  Scatter scatter;
  scatter.add(all, false);
  double angle = scatter.minor_axis();
  const Eigen::Vector2d mean(origin.x + all.x / all.n, origin.y + all.y / all.n);
  if (direction(angle).dot(mean) < 0.0) angle += std::numbers::pi;
  Eigen::Vector2d p(direction(angle).dot(mean), angle);
  FaceFit fit;
  const auto squares = minimise<FaceModel>(points, p, fit.covariance);
  if (!squares) return std::nullopt;
  fit.distance = p(0);
  fit.normal = std::remainder(p(1), 2.0 * std::numbers::pi);
  fit.squares = *squares;
  fit.covariance *= variance_of(fit.squares, points.size(), FaceModel::kSize, noise);
  return fit;
}

}  // namespace ttf::sensors::laser
