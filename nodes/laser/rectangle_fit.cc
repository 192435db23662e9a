#include "nodes/laser/rectangle_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "nodes/laser/orientation_search.h"

namespace ttf::nodes::laser {
namespace {

constexpr double kPi = std::numbers::pi;
// What an outline's extent is trusted to besides noise and beams: the orientation's error leaves some centimetres.
constexpr double kShapeSigma_m = 0.05;
// A side seen so flatly that its returns are further apart may have been cut off anywhere.
constexpr double kWidestSpacing_m = 1.2;

// The returns seen along one axis of a candidate rectangle: extent, and the face turned to the sensor if there is one.
struct Axis {
  double cx = 1, sy = 0;     // direction
  double low = 0, high = 0;  // extent of the projections
  bool visible = false;      // a face normal to this axis is turned to the sensor
  double near = 0, far = 0;  // its position, and the other end
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
  axis.far = axis.away > 0 ? axis.high : axis.low;
  axis.visible = axis.low > 0.0 || axis.high < 0.0;
  return axis;
}

// The search's angle, refined: least squares of the returns' distances to their faces. With the returns of the second
// face turned by a quarter, both share one normal, the minor axis of the summed scatter about each face's mean.
double refined_angle(double angle, std::span<const PlanePoint> points) {
  constexpr double kLargestStep = 0.15;
  for (int iteration = 0; iteration < 3; ++iteration) {
    const Axis axes[2] = {axis_at(angle, points), axis_at(angle + 0.5 * kPi, points)};
    double n[2] = {}, x[2] = {}, y[2] = {}, xx[2] = {}, xy[2] = {}, yy[2] = {};
    for (const PlanePoint& point : points) {
      const double d0 = std::abs(axes[0].project(point) - axes[0].near);
      const double d1 = std::abs(axes[1].project(point) - axes[1].near);
      const int face = !axes[1].visible || (axes[0].visible && d0 <= d1) ? 0 : 1;
      // Relative to one of the returns: far from the sensor the squares would lose digits.
      const double px = point.x - points.front().x, py = point.y - points.front().y;
      n[face] += 1.0;
      x[face] += px;
      y[face] += py;
      xx[face] += px * px;
      xy[face] += px * py;
      yy[face] += py * py;
    }
    double sxx = 0.0, sxy = 0.0, syy = 0.0;
    for (int face = 0; face < 2; ++face) {
      if (n[face] == 0.0) continue;
      const double fxx = xx[face] - x[face] * x[face] / n[face], fxy = xy[face] - x[face] * y[face] / n[face];
      const double fyy = yy[face] - y[face] * y[face] / n[face];
      sxx += face == 0 ? fxx : fyy;
      sxy += face == 0 ? fxy : -fxy;
      syy += face == 0 ? fyy : fxx;
    }
    const double normal = 0.5 * std::atan2(2.0 * sxy, sxx - syy) + 0.5 * kPi;
    const double step = std::remainder(normal - angle, kPi);
    if (std::abs(step) > kLargestStep) break;
    angle += step;
    if (std::abs(step) < 1e-4) break;
  }
  return angle;
}

// A vehicle of nominal size behind what little was seen: centre half a length behind, uncertain in every direction.
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
  // Anything between the half width and the half length: uniform over that span, in both directions.
  const double spread =
      0.5 * (config.nominal_length_m - config.nominal_width_m) / std::sqrt(3.0) + config.nominal_width_m / 2;
  object.sxx = object.syy = spread * spread;
  return object;
}

// Mean position of the face normal to `axis`: of the returns nearer to it than to the other face.
double face(const Axis& axis, const Axis& other, std::span<const PlanePoint> points, int& count) {
  double sum = 0.0;
  count = 0;
  for (const PlanePoint& point : points) {
    const double d = std::abs(axis.project(point) - axis.near);
    const double d_other = other.visible ? std::abs(other.project(point) - other.near) : d + 1.0;
    if (d > d_other) continue;
    sum += axis.project(point);
    ++count;
  }
  return count > 0 ? sum / count : axis.near;
}

// Mean of the returns of the beam at `azimuth`.
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

}  // namespace

LaserObject fit_rectangle(const RectangleConfig& config, std::span<const PlanePoint> points) {
  LaserObject object;
  const double noise = config.range_noise_m;
  bool shaped = points.size() >= 3;
  Axis axes[2];
  if (shaped) {
    const double angle = refined_angle(search_orientation(points, noise), points);
    axes[0] = axis_at(angle, points);
    axes[1] = axis_at(angle + 0.5 * kPi, points);
    shaped = std::max(axes[0].high - axes[0].low, axes[1].high - axes[1].low) > 0.5;
  }
  if (!shaped || !(axes[0].visible || axes[1].visible)) {
    object = speck(config, points);
    object.length = config.nominal_length_m;
    object.width = config.nominal_width_m;
    object.sigma_length = config.length_sigma_m;
    object.sigma_width = config.width_sigma_m;
    object.sigma_heading = kPi / std::sqrt(3.0);
    object.points = static_cast<int>(points.size());
    return object;
  }

  // Extents, from the returns of the outermost beams: these end the outline on either side. Means over their layers,
  // since the extremes of many noisy returns would lie outside. The outline ends up to one beam's spacing further on.
  const PlanePoint first = end_of(points, points.front().azimuth, config.azimuth_step_rad);
  const PlanePoint last = end_of(points, points.back().azimuth, config.azimuth_step_rad);
  double near[2], ends_middle[2], extent[2], extent_sigma[2], steepness[2];
  bool measured[2];
  int near_count[2];
  for (int k = 0; k < 2; ++k) {
    const Axis& axis = axes[k];
    const Axis& other = axes[1 - k];
    near[k] = face(axis, other, points, near_count[k]);
    const double a = axis.project(first), b = axis.project(last);
    const PlanePoint& far = axis.away * a > axis.away * b ? first : last;
    ends_middle[k] = 0.5 * (a + b);
    // Along axis k runs the face normal to the other axis: seen only if that one is visible. Its returns are spaced by
    // the beams' step over the sine of the incidence.
    const double range = std::max(0.1, std::hypot(far.x, far.y));
    steepness[k] = std::abs(axis.cx * far.y - axis.sy * far.x) / range;
    const double spacing = range * config.azimuth_step_rad / std::max(0.01, steepness[k]);
    const double raw = axis.visible ? axis.away * (axis.project(far) - near[k]) : std::abs(a - b);
    extent[k] = !other.visible ? raw : axis.visible ? raw + 0.5 * spacing : raw + spacing;
    // Each end that is not a corner in view: uniform over the spacing.
    extent_sigma[k] = std::hypot(spacing * std::sqrt((axis.visible ? 1.0 : 2.0) / 12.0), noise, kShapeSigma_m);
    measured[k] = other.visible && raw > std::max(0.4, 4.0 * noise) && spacing < kWidestSpacing_m;
  }
  // Which axis the vehicle's length runs along: the one with an extent no width reaches, else across the rear.
  int along;
  const double whole[2] = {measured[0] ? extent[0] : 0.0, measured[1] ? extent[1] : 0.0};
  if (std::max(whole[0], whole[1]) > config.widest_rear_m)
    along = whole[0] > whole[1] ? 0 : 1;
  else if (measured[0] != measured[1])
    along = measured[0] ? 1 : 0;
  else
    along = steepness[0] < steepness[1] ? 0 : 1;  // a face seen steeply is seen whole
  const int across = 1 - along;

  object.has_length = measured[along] && extent[along] > config.widest_rear_m;
  object.has_width =
      measured[across] && extent[across] > config.narrowest_width_m && extent[across] < config.widest_rear_m;
  object.length = object.has_length ? extent[along] : config.nominal_length_m;
  object.width = object.has_width ? extent[across] : config.nominal_width_m;
  object.sigma_length = object.has_length ? extent_sigma[along] : config.length_sigma_m;
  object.sigma_width = object.has_width ? extent_sigma[across] : config.width_sigma_m;
  object.has_heading = object.has_length || object.has_width;
  object.heading = std::atan2(axes[along].sy * axes[along].away, axes[along].cx * axes[along].away);
  const double longest = std::max(object.has_length ? extent[along] : 0.0, object.has_width ? extent[across] : 0.0);
  object.sigma_heading = object.has_heading
                             ? 0.02 + noise * std::sqrt(12.0 / static_cast<double>(points.size())) / longest
                             : kPi / std::sqrt(3.0);

  const double size[2] = {along == 0 ? object.length : object.width, along == 0 ? object.width : object.length};
  const double size_sigma[2] = {along == 0 ? object.sigma_length : object.sigma_width,
                                along == 0 ? object.sigma_width : object.sigma_length};
  double centre[2], variance[2];
  for (int k = 0; k < 2; ++k) {
    if (axes[k].visible) {
      centre[k] = near[k] + axes[k].away * 0.5 * size[k];
      variance[k] = noise * noise / std::max(1, near_count[k]) + 0.25 * size_sigma[k] * size_sigma[k];
    } else {
      centre[k] = ends_middle[k];
      // Where only part of a face was seen, its middle may be anywhere within what is missing.
      const double missing = std::max(0.0, size[k] - (axes[k].high - axes[k].low));
      variance[k] = 0.25 * extent_sigma[k] * extent_sigma[k] + missing * missing / 12.0;
    }
    variance[k] += 1e-4;  // nothing is known better than to a centimetre
  }
  const double c = axes[0].cx, s = axes[0].sy;
  object.x = c * centre[0] + axes[1].cx * centre[1];
  object.y = s * centre[0] + axes[1].sy * centre[1];
  object.sxx = c * c * variance[0] + s * s * variance[1];
  object.syy = s * s * variance[0] + c * c * variance[1];
  object.sxy = c * s * (variance[0] - variance[1]);
  object.points = static_cast<int>(points.size());
  return object;
}

}  // namespace ttf::nodes::laser
