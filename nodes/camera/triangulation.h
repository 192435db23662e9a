// From a stereo camera's detection to an object's position.
//
// Depth z = f b / d along the optical axis (x), x = z, y = z tan(bearing) (rectified pinhole pair). What the pair sees is the
// middle of the outline turned to it; the object's centre lies further along the line of sight, by half its length seen from
// front or rear, less when it is turned: a nominal distance with its spread. The
// covariance is the first-order one of disparity, bearing and that half length; depth noise so grows with the square
// of the range.
#pragma once

#include "core/strict_yaml.h"

namespace ttf::nodes {

struct CameraCalibration {
  double baseline_m = 0.4;
  double focal_px = 1100.0;
  double disparity_sigma_px = 0.3;
  double bearing_sigma_rad = 0.003;
  double width_sigma_px = 2.0;
  double half_length_m = 2.1, half_length_sigma_m = 0.4;   // a passenger car's: 2.2 from behind, 1.6 turned by 40 degrees
};
CameraCalibration load_camera_calibration(YamlMap& yaml);

struct CameraObject {
  double x = 0, y = 0, sxx = 0, sxy = 0, syy = 0;   // centre [m] and covariance
  double width = 0, sigma_width = 0;                // [m]
};

// bearing [rad] within +-1.5, disparity [px] above zero, width [px].
CameraObject triangulate(const CameraCalibration& calibration, double bearing, double disparity, double width_px);

}  // namespace ttf::nodes
