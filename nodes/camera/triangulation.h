// Computes an object's position from a stereo camera's detection.
//
// Depth z = f b / d along the optical axis (x), x = z, y = z tan(bearing) (rectified pinhole pair). The pair
// sees the silhouette's middle, at the mean depth of the outline turned to it. The centre lies further along
// the line of sight. A rectangle L by B under a silhouette of width W has the mean chord L B / W, so its centre
// lies half of that behind (exact in the far field). The distance is L / 2 for a car seen from behind (W = B),
// and B / 2 for one seen from the side (W = L). W is measured, L and B are nominal.
//
// The covariance is first-order in disparity, bearing, width and that distance, so depth noise grows with the
// square of the range. The perspective of a turned car adds an error across the line of sight. Its outermost
// corners are opposite ones, (u, v) and (-u, -v) from the centre with u = W / 2 and
// u^2 + v^2 = (L^2 + B^2) / 4. They move the silhouette's middle by u v / range, to an unknown side.
#pragma once

#include "core/strict_yaml.h"
#include "fusion/sensors/plane_position.h"

namespace ttf::nodes::camera {

struct CameraCalibration {
  double baseline_m = 0.4;
  double focal_px = 1100.0;
  double disparity_sigma_px = 0.3;
  double bearing_sigma_rad = 0.003;
  double width_sigma_px = 2.0;
  double half_length_m = 2.2, half_length_sigma_m = 0.2;  // a passenger car's, and its fleet's spread
  double nominal_width_m = 1.8;
};
CameraCalibration load_camera_calibration(YamlMap& yaml);

// An object; its position is that of its centre.
struct CameraObject : ttf::fusion::sensors::PlanePosition {
  double width = 0, sigma_width = 0;  // the silhouette's, across the line of sight [m]
  double span = 0, sigma_span = 0;    // the angle under which it is seen [rad]
};

// Computes the object of a silhouette. `bearing` [rad] lies within +-1.5, `disparity` [px] is positive, and
// `width_px` is f * span / cos(bearing).
CameraObject triangulate(const CameraCalibration& calibration, double bearing, double disparity, double width_px);

}  // namespace ttf::nodes::camera
