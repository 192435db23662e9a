// Computes the position of a box in the picture of a camera with one lens, by the ground plane.
//
// The bottom of the box, at row v, is the outline's nearest point at depth x = h / tan(pitch + atan(v / f)). A row's error
// moves it by (x^2 + h^2) / h f / (f^2 + v^2), about x^2 / (f h): it grows with the square of the range. An error of the
// pitch moves it by (x^2 + h^2) / h.
//
// The tracker has silhouettes: the outline's mean distance, in the middle of its span (fusion/tracks/body/anchor.h). From the
// nearest point to there it is up to half a car's length, as the car is turned. The box shows the turn by its width: of all
// headings, a car of usual size has those whose silhouettes have this span. Their mean distance is added, and their
// spread is part of the covariance. The usual size is that of the box's class.
#pragma once

#include <array>
#include <cstdint>

#include "core/strict_yaml.h"
#include "sensors/mono_camera/mark_memory.h"
#include "sensors/stereo_camera/triangulation.h"

namespace ttf::sensors::mono_camera {

using stereo_camera::CameraObject;

struct MonoCalibration {
  double height_m = 1.3;
  double focal_px = 1100.0;
  double pitch_rad = 0.0;        // known; positive if the camera looks down
  double pitch_sigma_rad = 0.0;  // the rest, taken for noise of each box
  double column_sigma_px = 1.0, row_sigma_px = 1.0;
  MarkCalibration marks;  // of lanes
};
MonoCalibration load_mono_calibration(YamlMap& yaml);

// Edges [px] from the middle of the picture, columns to the right and rows downwards.
struct PictureBox {
  double left = 0.0, right = 0.0, bottom = 0.0;
  int class_code = 0;  // sim::world::traffic::ObjectClass, as on the bus; an unknown one is a car's
};

class GroundPlane {
 public:
  explicit GroundPlane(const MonoCalibration& calibration);
  // Returns the silhouette of a box whose left edge lies left of its right one. A bottom at the horizon or above is taken
  // for half a standard deviation below it.
  CameraObject locate(const PictureBox& box) const;

 private:
  // A heading, from the line of sight.
  struct Turn {
    double c = 1.0, s = 0.0;
  };
  static constexpr std::size_t kTurns = 72;  // 2.5 degrees apart, through half a turn

  MonoCalibration k_;
  std::array<Turn, kTurns> turns_;
};

}  // namespace ttf::sensors::mono_camera
