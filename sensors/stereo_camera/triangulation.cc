#include "sensors/stereo_camera/triangulation.h"

#include <algorithm>
#include <cmath>

namespace ttf::sensors::stereo_camera {

CameraCalibration load_camera_calibration(YamlMap& yaml) {
  CameraCalibration c;
  c.baseline_m = yaml.number_or("baseline", c.baseline_m, {0.01, 5.0}, "m");
  c.focal_px = yaml.number_or("focal", c.focal_px, {50.0, 20000.0}, "px");
  c.disparity_sigma_px = yaml.number_or("disparity_sigma", c.disparity_sigma_px, {0.001, 20.0}, "px");
  c.bearing_sigma_rad = yaml.number_or("bearing_sigma", c.bearing_sigma_rad, {1e-5, 0.5}, "rad");
  c.width_sigma_px = yaml.number_or("width_sigma", c.width_sigma_px, {0.01, 100.0}, "px");
  for (const char* key : {"half_length", "half_length_sigma", "nominal_width"})
    yaml.gone(key, "preprocessing says what it sees, and the tracker knows how long and wide objects are");
  return c;
}

CameraObject triangulate(const CameraCalibration& k, double bearing, double disparity, double width_px) {
  // Noise may bring a disparity near zero, and its object to infinity: half a sigma above zero is the limit.
  const double d = std::max(disparity, 0.5 * k.disparity_sigma_px);
  const double depth = k.focal_px * k.baseline_m / d;
  const double t = std::tan(bearing), c = std::cos(bearing);
  const double vd = k.disparity_sigma_px * k.disparity_sigma_px, vb = k.bearing_sigma_rad * k.bearing_sigma_rad;
  CameraObject object;
  object.x = depth;
  object.y = depth * t;
  object.add_error(-depth / d, -depth * t / d, vd);
  object.add_error(0.0, depth / (c * c), vb);
  // The span does not depend on depth.
  object.span = width_px * c / k.focal_px;
  object.sigma_span = k.width_sigma_px * c / k.focal_px;
  return object;
}

}  // namespace ttf::sensors::stereo_camera
