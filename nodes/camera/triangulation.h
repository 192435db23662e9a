// From a stereo camera's detection to an object's position.
//
// Depth z = f b / d along the optical axis (x), x = z, y = z tan(bearing) (rectified pinhole pair). What the pair sees
// is the silhouette's middle at the mean depth of the outline turned to it; the centre lies further along the line of
// sight. For a rectangle L by B seen under a silhouette of width W the mean chord is L B / W, so the centre is half of
// that behind (exact in the far field): L / 2 for a car seen from behind (W = B), B / 2 for one seen from the side (W =
// L). W is measured, L and B are nominal.
//
// The covariance is the first-order one of disparity, bearing, width and that distance; depth noise so grows with the
// square of the range. Across the line of sight there is the perspective of a turned car besides: its outermost corners
// are opposite ones, (u, v) and (-u, -v) from the centre with u = W / 2 and u^2 + v^2 = (L^2 + B^2) / 4, which moves
// the silhouette's middle by u v / range to a side that is not known.
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

// The position is the centre's.
struct CameraObject : ttf::fusion::sensors::PlanePosition {
  double width = 0, sigma_width = 0;  // of the silhouette, across the line of sight [m]
  double span = 0, sigma_span = 0;    // the angle it subtends [rad]
};

// bearing [rad] within +-1.5, disparity [px] above zero, width [px]: the silhouette's, f * span / cos(bearing).
CameraObject triangulate(const CameraCalibration& calibration, double bearing, double disparity, double width_px);

}  // namespace ttf::nodes::camera
