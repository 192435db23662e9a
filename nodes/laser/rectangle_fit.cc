#include "nodes/laser/rectangle_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "nodes/laser/orientation_search.h"

namespace ttf::nodes::laser {
namespace {

constexpr double kPi = std::numbers::pi;
// The standard deviation [rad] of a heading that is uniform over half a turn to either side.
const double kUnknownHeading = kPi / std::sqrt(3.0);
// Uncertainty of an outline's extent besides noise and beams: the orientation's error leaves some centimetres.
constexpr double kShapeSigma_m = 0.05;
// A side whose returns are further apart is seen too flatly: it may have been cut off anywhere.
constexpr double kWidestSpacing_m = 1.2;
// Shorter outlines have no orientation.
constexpr double kSmallestShape_m = 0.5;
// A shorter face does not count as a face, whatever the noise.
constexpr double kShortestFace_m = 0.4;
// The smallest variance: one centimetre, squared.
constexpr double kCentimetre_m2 = 1e-4;

// The returns along one axis of a candidate rectangle: their extent, and the face turned to the sensor, if any.
struct Axis {
  double cx = 1, sy = 0;     // direction
  double low = 0, high = 0;  // extent of the projections
  bool visible = false;      // a face normal to this axis is turned to the sensor
  double near = 0;           // the position of that face
  double away = 1;           // sign of the direction away from the sensor
  double project(const PlanePoint& p) const { return cx * p.x + sy * p.y; }
};

Axis axis_at(double angle, std::span<const PlanePoint> points) {
  Axis axis;
  axis.cx = std::cos(angle);
  axis.sy = std::sin(angle);
  axis.low = std::numeric_limits<double>::infinity();
  axis.high = -axis.low;
  for (const PlanePoint& point : points) {
    const double c = axis.project(point);
    axis.low = std::min(axis.low, c);
    axis.high = std::max(axis.high, c);
  }
  axis.away = axis.low + axis.high >= 0.0 ? 1.0 : -1.0;
  axis.near = axis.away > 0 ? axis.low : axis.high;
  axis.visible = axis.low > 0.0 || axis.high < 0.0;
  return axis;
}

// Moments of a face's returns.
struct Moments {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  void add(double px, double py) {
    n += 1.0;
    x += px;
    y += py;
    xx += px * px;
    xy += px * py;
    yy += py * py;
  }
};

// The summed scatter about each face's mean; the returns of the second face are turned by a quarter.
struct Scatter {
  double xx = 0.0, xy = 0.0, yy = 0.0;
  void add(const Moments& face, bool turned) {
    if (face.n == 0.0) return;
    const double fxx = face.xx - face.x * face.x / face.n, fxy = face.xy - face.x * face.y / face.n;
    const double fyy = face.yy - face.y * face.y / face.n;
    xx += turned ? fyy : fxx;
    xy += turned ? -fxy : fxy;
    yy += turned ? fxx : fyy;
  }
  // Returns the direction of the least scatter.
  double minor_axis() const { return 0.5 * std::atan2(2.0 * xy, xx - yy) + 0.5 * kPi; }
};

// Assigns each return to the nearer visible face.
Scatter scatter_about(const Axis (&axes)[2], std::span<const PlanePoint> points) {
  Moments faces[2];
  for (const PlanePoint& point : points) {
    const double d0 = std::abs(axes[0].project(point) - axes[0].near);
    const double d1 = std::abs(axes[1].project(point) - axes[1].near);
    const int face = !axes[1].visible || (axes[0].visible && d0 <= d1) ? 0 : 1;
    // Relative to one of the returns: far from the sensor, squares would lose digits.
    faces[face].add(point.x - points.front().x, point.y - points.front().y);
  }
  Scatter scatter;
  scatter.add(faces[0], false);
  scatter.add(faces[1], true);
  return scatter;
}

// Refines the search's angle by least squares over the returns' distances to their faces. With the returns of
// the second face turned by a quarter, both faces share one normal: the minor axis of their scatter.
double refined_angle(double angle, std::span<const PlanePoint> points) {
  constexpr int kMostSteps = 3;
  constexpr double kLargestStep = 0.15, kSmallestStep = 1e-4;
  for (int iteration = 0; iteration < kMostSteps; ++iteration) {
    const Axis axes[2] = {axis_at(angle, points), axis_at(angle + 0.5 * kPi, points)};
    const double step = std::remainder(scatter_about(axes, points).minor_axis() - angle, kPi);
    if (std::abs(step) > kLargestStep) break;
    angle += step;
    if (std::abs(step) < kSmallestStep) break;
  }
  return angle;
}

// Returns a vehicle of nominal size for a few returns. Its centre lies behind them by the mean of half the
// length and half the width, and is uncertain in every direction.
LaserObject speck(const RectangleConfig& config, std::span<const PlanePoint> points) {
  double x = 0, y = 0;
  for (const PlanePoint& point : points) {
    x += point.x;
    y += point.y;
  }
  x /= static_cast<double>(points.size());
  y /= static_cast<double>(points.size());
  const double range = std::max(1e-3, std::hypot(x, y)),
               shift = 0.25 * (config.nominal_length_m + config.nominal_width_m);
  LaserObject object;
  object.x = x * (1.0 + shift / range);
  object.y = y * (1.0 + shift / range);
  // The centre's distance is between half the width and half the length; half the width is added, in both directions.
  const double spread =
      0.5 * (config.nominal_length_m - config.nominal_width_m) / std::sqrt(3.0) + config.nominal_width_m / 2;
  object.sxx = object.syy = spread * spread;
  object.length = config.nominal_length_m;
  object.width = config.nominal_width_m;
  object.sigma_length = config.length_sigma_m;
  object.sigma_width = config.width_sigma_m;
  object.sigma_heading = kUnknownHeading;
  object.points = static_cast<int>(points.size());
  return object;
}

// The face normal to an axis: the mean position and the number of its returns. A return counts for the nearer face.
struct Face {
  double position = 0.0;
  int returns = 0;
};
Face face(const Axis& axis, const Axis& other, std::span<const PlanePoint> points) {
  double sum = 0.0;
  int count = 0;
  for (const PlanePoint& point : points) {
    const double d = std::abs(axis.project(point) - axis.near);
    const double d_other = other.visible ? std::abs(other.project(point) - other.near) : d + 1.0;
    if (d > d_other) continue;
    sum += axis.project(point);
    ++count;
  }
  return {count > 0 ? sum / count : axis.near, count};
}

// Returns the mean of the returns of the beam at `azimuth`.
PlanePoint end_of(std::span<const PlanePoint> points, double azimuth, double step) {
  PlanePoint mean{0.0, 0.0, azimuth, 0.0};
  int count = 0;
  for (const PlanePoint& point : points) {
    if (std::abs(point.azimuth - azimuth) > 0.5 * step) continue;
    mean.x += point.x;
    mean.y += point.y;
    ++count;
  }
  mean.x /= count;
  mean.y /= count;
  return mean;
}

// The two ends of the outline: the returns of the outermost beams. Each is a mean over its layers, since the
// extremes of many noisy returns would lie outside.
struct Ends {
  PlanePoint first, last;
};

// The outline along one axis.
struct Extent {
  Face near;                 // the face normal to the axis
  double ends_middle = 0.0;  // midway between the outermost beams
  double length = 0.0, sigma = 0.0;
  double steepness = 0.0;  // sine of the incidence at the far end
  bool measured = false;   // a face was seen along the axis
};

// Measures the outline along `axis`. The face along it is normal to `other`, and seen only if `other` is
// visible. Its returns are spaced by the beams' step over the sine of the incidence. The outline ends up to one
// such spacing after the last return.
Extent extent_along(const Axis& axis, const Axis& other, const Ends& ends, std::span<const PlanePoint> points,
                    const RectangleConfig& config) {
  constexpr double kNearest_m = 0.1, kFlattest = 0.01;
  const double noise = config.range_noise_m;
  Extent extent;
  extent.near = face(axis, other, points);
  const double a = axis.project(ends.first), b = axis.project(ends.last);
  const PlanePoint& far = axis.away * a > axis.away * b ? ends.first : ends.last;
  extent.ends_middle = 0.5 * (a + b);
  const double range = std::max(kNearest_m, std::hypot(far.x, far.y));
  extent.steepness = std::abs(axis.cx * far.y - axis.sy * far.x) / range;
  const double spacing = range * config.azimuth_step_rad / std::max(kFlattest, extent.steepness);
  const double seen = axis.visible ? axis.away * (axis.project(far) - extent.near.position) : std::abs(a - b);
  extent.length = !other.visible ? seen : axis.visible ? seen + 0.5 * spacing : seen + spacing;
  // Each end without a visible corner is uniform over the spacing.
  extent.sigma = std::hypot(spacing * std::sqrt((axis.visible ? 1.0 : 2.0) / 12.0), noise, kShapeSigma_m);
  extent.measured = other.visible && seen > std::max(kShortestFace_m, 4.0 * noise) && spacing < kWidestSpacing_m;
  return extent;
}

// Returns the axis of the vehicle's length: the one with an extent beyond any width, else the one across the rear.
int length_axis(const Extent (&extents)[2], const RectangleConfig& config) {
  const double whole[2] = {extents[0].measured ? extents[0].length : 0.0,
                           extents[1].measured ? extents[1].length : 0.0};
  if (std::max(whole[0], whole[1]) > config.widest_rear_m) return whole[0] > whole[1] ? 0 : 1;
  if (extents[0].measured != extents[1].measured) return extents[0].measured ? 1 : 0;
  return extents[0].steepness < extents[1].steepness ? 0 : 1;  // a face seen steeply is seen whole
}

void set_size(LaserObject& object, const Extent& along, const Extent& across, const RectangleConfig& config) {
  object.has_length = along.measured && along.length > config.widest_rear_m;
  object.has_width =
      across.measured && across.length > config.narrowest_width_m && across.length < config.widest_rear_m;
  object.length = object.has_length ? along.length : config.nominal_length_m;
  object.width = object.has_width ? across.length : config.nominal_width_m;
  object.sigma_length = object.has_length ? along.sigma : config.length_sigma_m;
  object.sigma_width = object.has_width ? across.sigma : config.width_sigma_m;
}

// Sets the heading. With a known size, it is as good as the longest face and its number of returns.
void set_heading(LaserObject& object, const Axis& along, std::size_t returns, double noise) {
  constexpr double kSearchSigma = 0.02;
  object.has_heading = object.has_length || object.has_width;
  object.heading = std::atan2(along.sy * along.away, along.cx * along.away);
  const double longest = std::max(object.has_length ? object.length : 0.0, object.has_width ? object.width : 0.0);
  object.sigma_heading = object.has_heading
                             ? kSearchSigma + noise * std::sqrt(12.0 / static_cast<double>(returns)) / longest
                             : kUnknownHeading;
}

// A length and its standard deviation [m].
struct Size {
  double value, sigma;
};
struct Centre {
  double position, variance;
};
// Returns the centre of a vehicle of that size along the axis.
Centre centre_along(const Axis& axis, const Extent& extent, const Size& size, double noise) {
  if (axis.visible)
    return {extent.near.position + axis.away * 0.5 * size.value,
            noise * noise / std::max(1, extent.near.returns) + 0.25 * size.sigma * size.sigma + kCentimetre_m2};
  // If only part of a face was seen, its middle may be anywhere within the missing part.
  const double missing = std::max(0.0, size.value - (axis.high - axis.low));
  return {extent.ends_middle, 0.25 * extent.sigma * extent.sigma + missing * missing / 12.0 + kCentimetre_m2};
}

// Sets the position from the vehicle's centre along either axis.
void set_position(LaserObject& object, const Axis (&axes)[2], const Centre& first, const Centre& second) {
  const double c = axes[0].cx, s = axes[0].sy;
  object.x = c * first.position + axes[1].cx * second.position;
  object.y = s * first.position + axes[1].sy * second.position;
  object.set_errors(c, s, first.variance, second.variance);
}

}  // namespace

LaserObject fit_rectangle(const RectangleConfig& config, std::span<const PlanePoint> points) {
  if (points.size() < 3) return speck(config, points);
  const double noise = config.range_noise_m;
  const double angle = refined_angle(search_orientation(points, noise), points);
  const Axis axes[2] = {axis_at(angle, points), axis_at(angle + 0.5 * kPi, points)};
  const bool shaped = std::max(axes[0].high - axes[0].low, axes[1].high - axes[1].low) > kSmallestShape_m;
  if (!shaped || !(axes[0].visible || axes[1].visible)) return speck(config, points);

  const Ends ends{end_of(points, points.front().azimuth, config.azimuth_step_rad),
                  end_of(points, points.back().azimuth, config.azimuth_step_rad)};
  const Extent extents[2] = {extent_along(axes[0], axes[1], ends, points, config),
                             extent_along(axes[1], axes[0], ends, points, config)};
  const int along = length_axis(extents, config), across = 1 - along;
  LaserObject object;
  set_size(object, extents[along], extents[across], config);
  set_heading(object, axes[along], points.size(), noise);
  const Size length{object.length, object.sigma_length}, width{object.width, object.sigma_width};
  set_position(object, axes, centre_along(axes[0], extents[0], along == 0 ? length : width, noise),
               centre_along(axes[1], extents[1], along == 0 ? width : length, noise));
  object.points = static_cast<int>(points.size());
  return object;
}

}  // namespace ttf::nodes::laser
