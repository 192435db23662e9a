#include "fusion/tracks/body/anchor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fusion/tracks/body/dual_number.h"

namespace ttf::fusion::tracks::body {
namespace {

using sensors::SeenPoint;

struct Point {
  DualNumber x, y;
};
Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y}; }
Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y}; }
Point operator*(double k, const Point& a) { return {k * a.x, k * a.y}; }
Point constant(const linear::Vector<2>& p) { return {DualNumber(p.x()), DualNumber(p.y())}; }
DualNumber length_of(const Point& a) { return sqrt(square(a.x) + square(a.y)); }
// The cross product of both vectors.
double cross(const Point& a, const Point& b) { return a.x.value * b.y.value - a.y.value * b.x.value; }

// The box as functions of its three numbers: half the sides along the object's axes.
struct Halves {
  Point along, across;

  explicit Halves(const Box& box) {
    const DualNumber half_length = 0.5 * DualNumber::variable(box.size(0), 0),
                     half_width = 0.5 * DualNumber::variable(box.size(1), 1);
    const auto [s, c] = sine_and_cosine(DualNumber::variable(box.heading, 2));
    along = {half_length * c, half_length * s};
    across = {-half_width * s, half_width * c};
  }
  Point offset(int a, int b) const { return static_cast<double>(a) * along + static_cast<double>(b) * across; }
};
// They follow each other counter-clockwise.
using Corners = std::array<Point, 4>;

struct Outline {
  Point middle;
  DualNumber span;
};

// The faces in view contribute to the mean range. They turn their outer side to the origin, on the right of the way from
// corner to corner. Returns no value without a face in view.
std::optional<DualNumber> integral_of_range(const Corners& corners) {
  constexpr double kNearest = 0.05;  // [m] from the origin to a face, at least
  std::array<DualNumber, 4> range;
  for (std::size_t k = 0; k < 4; ++k) range[k] = length_of(corners[k]);
  DualNumber integral;
  bool in_view = false;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    const Point side = corners[next] - corners[k];
    if (!(cross(corners[next], side) < 0.0)) continue;
    const DualNumber length = length_of(side);
    const DualNumber distance = (corners[next].x * side.y - corners[next].y * side.x) / length;
    in_view = in_view || distance.value < -kNearest;
    const DualNumber sum = range[k] + range[next];
    integral = integral - distance * log((sum + length) / (sum - length));
  }
  if (!in_view) return std::nullopt;
  return integral;
}

// The azimuths of the outermost corners, from that of the centre, in the direction (c, s), on.
struct Azimuths {
  DualNumber low, high;
};
Azimuths outermost(const Corners& corners, const DualNumber& c, const DualNumber& s) {
  std::array<double, 4> turned{};  // grows with the azimuth; mostly the tangent tells enough
  bool in_front = true;
  for (std::size_t k = 0; k < 4; ++k) {
    const double along = c.value * corners[k].x.value + s.value * corners[k].y.value;
    in_front = in_front && along > 0.0;
    turned[k] = (c.value * corners[k].y.value - s.value * corners[k].x.value) / along;
  }
  const auto azimuth_of = [&](const Point& corner) {
    return atan2(c * corner.y - s * corner.x, c * corner.x + s * corner.y);
  };
  if (!in_front)
    for (std::size_t k = 0; k < 4; ++k) turned[k] = azimuth_of(corners[k]).value;
  const auto [low, high] = std::minmax_element(turned.begin(), turned.end());
  return {azimuth_of(corners[static_cast<std::size_t>(low - turned.begin())]),
          azimuth_of(corners[static_cast<std::size_t>(high - turned.begin())])};
}

// Flattened for speed: the compiler would call a function for every sum.
[[gnu::flatten]] std::optional<Outline> outline_of(const Point& centre, const Halves& halves) {
  const Corners corners{centre + halves.offset(1, 1), centre + halves.offset(-1, 1), centre + halves.offset(-1, -1),
                        centre + halves.offset(1, -1)};
  const std::optional<DualNumber> integral = integral_of_range(corners);
  if (!integral) return std::nullopt;
  const DualNumber reach = length_of(centre), c = centre.x / reach, s = centre.y / reach;
  const auto [low, high] = outermost(corners, c, s);
  const DualNumber span = high - low, mean = *integral / span;
  const auto [ts, tc] = sine_and_cosine(0.5 * (low + high));
  return Outline{{mean * (c * tc - s * ts), mean * (s * tc + c * ts)}, span};
}

std::optional<Point> point_of(const Anchor& anchor, const Point& centre, const Halves& halves) {
  if (anchor.point != SeenPoint::kSilhouette) return centre + halves.offset(anchor.along, anchor.across);
  const Point from = constant(anchor.from);
  const std::optional<Outline> outline = outline_of(centre - from, halves);
  if (!outline) return std::nullopt;
  return outline->middle + from;
}

// A silhouette's centre lies so far behind it that its silhouette is there. The distance hardly depends on the place, so
// each step leaves a small part of the error.
std::optional<Point> centre_of(const Anchor& anchor, const Point& position, const Box& box, const Halves& halves) {
  if (anchor.point != SeenPoint::kSilhouette) return position - halves.offset(anchor.along, anchor.across);
  constexpr int kSteps = 3;
  const linear::Vector<2> sight = linear::Vector<2>(position.x.value, position.y.value) - anchor.from;
  const double range = sight.norm(), aspect = box.heading - std::atan2(sight.y(), sight.x());
  const double shown = box.size(0) * std::abs(std::sin(aspect)) + box.size(1) * std::abs(std::cos(aspect));
  if (!(range > 0.0) || !(shown > 0.0)) return std::nullopt;
  const double behind = 0.5 * box.size.prod() / shown;  // half the mean chord
  Point centre = position + constant(behind / range * sight);
  for (int k = 0; k < kSteps; ++k) {
    const std::optional<Point> seen = point_of(anchor, centre, halves);
    if (!seen) return std::nullopt;
    centre = centre + (position - *seen);
  }
  return centre;
}

Located located(const Point& point) {
  Located result;
  result.at << point.x.value, point.y.value;
  result.by_box.row(0) = point.x.by.head<3>().matrix().transpose();
  result.by_box.row(1) = point.y.by.head<3>().matrix().transpose();
  return result;
}

signed char sign_of(double value) { return value < 0.0 ? -1 : 1; }

signed char sign_away(const linear::Vector<2>& axis, const linear::Vector<2>& to_centre) {
  return axis.dot(to_centre) > 0.0 ? -1 : 1;
}

}  // namespace

Anchor anchor_of(SeenPoint point, const linear::Vector<2>& centre, const linear::Vector<2>& axis,
                 const linear::Vector<2>& from) {
  Anchor anchor{.point = point};
  if (point == SeenPoint::kCentre) return anchor;
  if (point == SeenPoint::kSilhouette) {
    anchor.from = from;
    return anchor;
  }
  const linear::Vector<2> across(-axis.y(), axis.x()), to_centre = centre - from;
  if (point != SeenPoint::kSide) anchor.along = sign_away(axis, to_centre);
  if (point != SeenPoint::kEnd) anchor.across = sign_away(across, to_centre);
  return anchor;
}

Anchor anchor_of(SeenPoint point, const linear::Vector<2>& centre, double heading, const linear::Vector<2>& from) {
  if (point == SeenPoint::kCentre || point == SeenPoint::kSilhouette)
    return anchor_of(point, centre, linear::Vector<2>::UnitX(), from);
  return anchor_of(point, centre, linear::Vector<2>(std::cos(heading), std::sin(heading)), from);
}

std::optional<Anchor> outermost_of(SeenPoint point, double into_face, const linear::Vector<2>& axis,
                                   const linear::Vector<2>& at, const linear::Vector<2>& from) {
  const linear::Vector<2> across(-axis.y(), axis.x()), into(std::cos(into_face), std::sin(into_face));
  const auto outwards = [&](const linear::Vector<2>& sight) -> linear::Vector<2> {
    return point == SeenPoint::kRightmost ? linear::Vector<2>(sight.y(), -sight.x())
                                          : linear::Vector<2>(-sight.y(), sight.x());
  };
  // The face is an end if it is passed along the axis rather than across it.
  const bool is_end = std::abs(axis.dot(into)) > std::abs(across.dot(into));
  const linear::Vector<2> on_face = outwards(into), seen = outwards(at - from);
  const signed char along = sign_of(is_end ? -axis.dot(into) : axis.dot(on_face)),
                    side = sign_of(is_end ? across.dot(on_face) : -across.dot(into));
  if (along != sign_of(axis.dot(seen)) || side != sign_of(across.dot(seen))) return std::nullopt;
  return Anchor{.point = SeenPoint::kCorner, .along = along, .across = side};
}

std::optional<Located> centre_of(const Anchor& anchor, const linear::Vector<2>& position, const Box& box) {
  const std::optional<Point> centre = centre_of(anchor, constant(position), box, Halves(box));
  if (!centre) return std::nullopt;
  return located(*centre);
}

std::optional<Located> point_of(const Anchor& other, const Anchor& anchor, const linear::Vector<2>& position,
                                const Box& box) {
  const Halves halves(box);
  const std::optional<Point> centre = centre_of(anchor, constant(position), box, halves);
  const std::optional<Point> point = centre ? point_of(other, *centre, halves) : std::nullopt;
  if (!point) return std::nullopt;
  return located(*point);
}

std::optional<Silhouette> silhouette_of(const linear::Vector<2>& centre, const Box& box) {
  const std::optional<Outline> outline = outline_of(constant(centre), Halves(box));
  if (!outline) return std::nullopt;
  return Silhouette{located(outline->middle), outline->span.value, outline->span.by.head<3>().matrix()};
}

}  // namespace ttf::fusion::tracks::body
