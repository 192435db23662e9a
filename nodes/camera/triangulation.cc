#include "nodes/camera/triangulation.h"

#include <algorithm>
#include <cmath>

namespace ttf::nodes {

CameraCalibration load_camera_calibration(YamlMap& yaml) {
  CameraCalibration c;
  c.baseline_m = yaml.number_or("baseline", c.baseline_m, {0.01, 5.0}, "m");
  c.focal_px = yaml.number_or("focal", c.focal_px, {50.0, 20000.0}, "px");
  c.disparity_sigma_px = yaml.number_or("disparity_sigma", c.disparity_sigma_px, {0.001, 20.0}, "px");
  c.bearing_sigma_rad = yaml.number_or("bearing_sigma", c.bearing_sigma_rad, {1e-5, 0.5}, "rad");
  c.width_sigma_px = yaml.number_or("width_sigma", c.width_sigma_px, {0.01, 100.0}, "px");
  c.half_length_m = yaml.number_or("half_length", c.half_length_m, {0.0, 10.0}, "m");
  c.half_length_sigma_m = yaml.number_or("half_length_sigma", c.half_length_sigma_m, {0.001, 5.0}, "m");
  return c;
}

CameraObject triangulate(const CameraCalibration& k, double bearing, double disparity, double width_px) {
  // A disparity that noise has brought near zero would be at infinity: as far as half a sigma above zero.
  const double d = std::max(disparity, 0.5 * k.disparity_sigma_px);
  const double depth = k.focal_px * k.baseline_m / d;
  const double t = std::tan(bearing), c = std::cos(bearing), s = std::sin(bearing);
  CameraObject object;
  object.x = depth + k.half_length_m * c;
  object.y = depth * t + k.half_length_m * s;
  // Columns of the Jacobian: disparity, bearing, half length.
  const double dx_dd = -depth / d, dy_dd = -depth * t / d;
  const double dx_db = -k.half_length_m * s, dy_db = depth / (c * c) + k.half_length_m * c;
  const double vd = k.disparity_sigma_px * k.disparity_sigma_px, vb = k.bearing_sigma_rad * k.bearing_sigma_rad;
  const double vh = k.half_length_sigma_m * k.half_length_sigma_m;
  object.sxx = dx_dd * dx_dd * vd + dx_db * dx_db * vb + c * c * vh;
  object.syy = dy_dd * dy_dd * vd + dy_db * dy_db * vb + s * s * vh;
  object.sxy = dx_dd * dy_dd * vd + dx_db * dy_db * vb + c * s * vh;
  object.width = width_px * depth / k.focal_px;
  const double dw_dd = -object.width / d, dw_dp = depth / k.focal_px;
  object.sigma_width = std::sqrt(dw_dd * dw_dd * vd + dw_dp * dw_dp * k.width_sigma_px * k.width_sigma_px);
  return object;
}

}  // namespace ttf::nodes
