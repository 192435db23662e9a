#include "nodes/camera/triangulation.h"

#include <algorithm>
#include <cmath>

namespace ttf::nodes::camera {

CameraCalibration load_camera_calibration(YamlMap& yaml) {
  CameraCalibration c;
  c.baseline_m = yaml.number_or("baseline", c.baseline_m, {0.01, 5.0}, "m");
  c.focal_px = yaml.number_or("focal", c.focal_px, {50.0, 20000.0}, "px");
  c.disparity_sigma_px = yaml.number_or("disparity_sigma", c.disparity_sigma_px, {0.001, 20.0}, "px");
  c.bearing_sigma_rad = yaml.number_or("bearing_sigma", c.bearing_sigma_rad, {1e-5, 0.5}, "rad");
  c.width_sigma_px = yaml.number_or("width_sigma", c.width_sigma_px, {0.01, 100.0}, "px");
  c.half_length_m = yaml.number_or("half_length", c.half_length_m, {0.0, 10.0}, "m");
  c.half_length_sigma_m = yaml.number_or("half_length_sigma", c.half_length_sigma_m, {0.001, 5.0}, "m");
  c.nominal_width_m = yaml.number_or("nominal_width", c.nominal_width_m, {0.5, 5.0}, "m");
  return c;
}

CameraObject triangulate(const CameraCalibration& k, double bearing, double disparity, double width_px) {
  // Noise may bring a disparity near zero, and its object to infinity: half a sigma above zero is the limit.
  const double d = std::max(disparity, 0.5 * k.disparity_sigma_px);
  const double depth = k.focal_px * k.baseline_m / d;
  const double t = std::tan(bearing), c = std::cos(bearing), s = std::sin(bearing);
  CameraObject object;
  object.width = width_px * depth / k.focal_px;
  const double dw_dd = -object.width / d, dw_dp = depth / k.focal_px;

  // From the outline to the centre: h = half length * nominal width / W, within the widths that a rectangle can show.
  const double length = 2.0 * k.half_length_m, breadth = k.nominal_width_m;
  const double widest = std::max(length, breadth), shown = std::clamp(object.width, breadth, widest);
  const bool turned = shown == object.width;
  const double h = k.half_length_m * breadth / shown;
  const double dh_dw = turned ? -h / shown : 0.0;
  object.x = depth + h * c;
  object.y = depth * t + h * s;

  const double vd = k.disparity_sigma_px * k.disparity_sigma_px, vb = k.bearing_sigma_rad * k.bearing_sigma_rad;
  const double vp = k.width_sigma_px * k.width_sigma_px, vh = k.half_length_sigma_m * k.half_length_sigma_m;
  // Columns of the Jacobian: disparity, bearing, width in the image; along the line of sight: half length.
  const double dx_dd = -depth / d + dh_dw * dw_dd * c, dy_dd = -depth * t / d + dh_dw * dw_dd * s;
  const double dx_db = -h * s, dy_db = depth / (c * c) + h * c;
  const double dx_dp = dh_dw * dw_dp * c, dy_dp = dh_dw * dw_dp * s;
  // Perspective across the line of sight; zero for a silhouette as narrow as a rear.
  const double u = 0.5 * shown, vv = std::max(0.0, 0.25 * (length * length + breadth * breadth) - u * u);
  const double narrow = breadth / shown, range = depth / c;
  const double across = u * u * vv / (range * range) * (1.0 - narrow * narrow);
  object.add_error(dx_dd, dy_dd, vd);
  object.add_error(dx_db, dy_db, vb);
  object.add_error(dx_dp, dy_dp, vp);
  object.add_errors(c, s, vh, across);
  object.sigma_width = std::sqrt(dw_dd * dw_dd * vd + dw_dp * dw_dp * vp);
  // The span does not depend on depth, so it is known far better than the width.
  object.span = width_px * c / k.focal_px;
  object.sigma_span = k.width_sigma_px * c / k.focal_px;
  return object;
}

}  // namespace ttf::nodes::camera
