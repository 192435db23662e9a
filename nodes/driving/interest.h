// A region of interest: the part of a camera's picture in which the next detection is to look for an object.
//
// It is the object's predicted box with a margin. It grows about its middle to a share of the picture's area, and moves
// into the picture. A pinhole camera sees a point at depth x, y to the left and z over ground, at
//   column -f y / x,  row f (h - z) / x.
#pragma once

#include <optional>

#include "nodes/vision/regions.h"
#include "recording/records/records.h"

namespace ttf::nodes::driving {

// A camera in the planner's model: its place on the vehicle, and its picture.
struct Picture {
  SensorId sensor = kNoSensor;
  double x = 0.0, y = 0.0, heading = 0.0;  // the mounting [m], [rad]
  double height_m = 1.3;                   // over ground
  double focal_px = 1100.0;
  double half_width_px = 530.0, half_height_px = 400.0;
};

struct InterestConfig {
  double margin_px = 20.0;       // on each side of the box
  double least_area = 0.6;       // a share of the picture; 0: no least area
  double object_height_m = 1.5;  // the image does not say it
};

// Returns the region of an object in the vehicle's axes, and none if the middle of its box is not in the picture.
std::optional<vision::Region> region_of(const Picture& picture, const InterestConfig& config,
                                        const recording::records::ImageObject& object);

}  // namespace ttf::nodes::driving
