// Computes the position of a stereo camera's detection: the middle of the silhouette, at the mean depth of the outline
// turned to the camera.
//
// Depth z = f b / d along the optical axis (x), x = z, y = z tan(bearing) (rectified pinhole pair). The covariance is
// first-order in disparity and bearing, so depth noise grows with the square of the range. Where the object's centre lies
// behind its silhouette is a matter of size and heading: the tracker's (fusion/tracks/body/anchor.h).
#pragma once

#include "core/strict_yaml.h"
#include "fusion/sensors/plane_position.h"

namespace ttf::sensors::stereo_camera {

struct CameraCalibration {
  double baseline_m = 0.4;
  double focal_px = 1100.0;
  double disparity_sigma_px = 0.3;
  double bearing_sigma_rad = 0.003;
  double width_sigma_px = 2.0;
};
CameraCalibration load_camera_calibration(YamlMap& yaml);

// The position is that of the silhouette.
struct CameraObject : ttf::fusion::sensors::PlanePosition {
  double span = 0, sigma_span = 0;  // the angle under which the object is seen [rad]
  int class_code = 0;               // if the camera tells classes (fusion/config/classes.h)
};

// Computes the object of a silhouette. `bearing` [rad] lies within +-1.5, `disparity` [px] is positive, and
// `width_px` is f * span / cos(bearing).
CameraObject triangulate(const CameraCalibration& calibration, double bearing, double disparity, double width_px);

}  // namespace ttf::sensors::stereo_camera
