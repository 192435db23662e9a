#include "recording/scene/geometry.h"

#include <algorithm>
#include <numbers>

namespace ttf::recording::scene {
namespace {

constexpr int kArcPoints = 32;

}  // namespace

std::vector<Point> ellipse(const records::ImageObject& object) {
  if (!std::isfinite(object.sigma_x) || !std::isfinite(object.sigma_y)) return {};
  const double rest = std::sqrt(std::max(0.0, 1.0 - object.correlation_xy * object.correlation_xy));
  std::vector<Point> points;
  for (int k = 0; k < kEllipsePoints; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kEllipsePoints, c = std::cos(angle), s = std::sin(angle);
    points.push_back({object.x + kEllipseSigmas * object.sigma_x * c,
                      object.y + kEllipseSigmas * object.sigma_y * (object.correlation_xy * c + rest * s)});
  }
  return points;
}

std::array<Point, 4> rectangle(const Pose& place, double length, double width) {
  const double c = std::cos(place.heading), s = std::sin(place.heading), l = 0.5 * length, w = 0.5 * width;
  const auto corner = [&](double along, double across) {
    return Point{place.x + c * along - s * across, place.y + s * along + c * across};
  };
  return {corner(l, w), corner(-l, w), corner(-l, -w), corner(l, -w)};
}

std::vector<Point> edge(const ViewedField& field) {
  const bool all_around = field.half_angle >= std::numbers::pi;
  const double half = all_around ? std::numbers::pi : field.half_angle;
  std::vector<Point> points;
  const auto arc = [&](double range, double from, double to) {
    for (int k = 0; k <= kArcPoints; ++k) {
      const double angle = from + (to - from) * k / kArcPoints;
      points.push_back({range * std::cos(angle), range * std::sin(angle)});
    }
  };
  arc(field.max_range, -half, half);
  if (all_around) return points;
  if (field.min_range > 0.0)
    arc(field.min_range, half, -half);
  else
    points.push_back({});
  return points;
}

// The vehicle's own way is taken as a straight line in the mean direction of its arc. The line is longer than the arc's chord by a
// 24th of the squared turn, which is 1 % for half a radian.
Pose moved_on(const Pose& place, double speed, const OwnMotion& own, double seconds) {
  const double turn = own.yaw_rate * seconds, way = speed * seconds, own_way = own.speed * seconds;
  const double x = place.x + way * std::cos(place.heading) - own_way * std::cos(0.5 * turn);
  const double y = place.y + way * std::sin(place.heading) - own_way * std::sin(0.5 * turn);
  const double c = std::cos(turn), s = std::sin(turn);
  return {c * x + s * y, c * y - s * x, place.heading - turn};
}

// Two convex outlines are apart if an edge of one has all corners of the other outside.
bool overlap(const std::array<Point, 4>& a, const std::array<Point, 4>& b) {
  const auto parts = [](const std::array<Point, 4>& of, const std::array<Point, 4>& other) {
    for (std::size_t i = 0; i < of.size(); ++i) {
      const Point &from = of[i], &to = of[(i + 1) % of.size()];
      bool outside = true;
      for (const Point& p : other)
        outside = outside && (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x) < 0.0;
      if (outside) return true;
    }
    return false;
  };
  return !parts(a, b) && !parts(b, a);
}

double way_curvature(const records::EgoTruth& ego) {
  constexpr double kSlowest_mps = 3.0;
  return ego.vx > kSlowest_mps ? ego.yaw_rate / ego.vx : 0.0;
}

std::optional<double> gap_ahead(const records::TruthState& object, double front_m, double width_m, double curvature) {
  if (object.x <= 0.0) return std::nullopt;
  const double heading = object.heading - curvature * object.x;  // from the way
  const double c = std::abs(std::cos(heading)), s = std::abs(std::sin(heading));
  const double along = 0.5 * (object.length * c + object.width * s),
               across = 0.5 * (object.length * s + object.width * c);
  if (std::abs(object.y - 0.5 * curvature * object.x * object.x) > across + 0.5 * width_m) return std::nullopt;
  return object.x - along - front_m;
}

std::vector<Point> mounted(const Pose& mounting, std::vector<Point> points) {
  const double c = std::cos(mounting.heading), s = std::sin(mounting.heading);
  for (Point& p : points) p = {mounting.x + c * p.x - s * p.y, mounting.y + s * p.x + c * p.y};
  return points;
}

}  // namespace ttf::recording::scene
