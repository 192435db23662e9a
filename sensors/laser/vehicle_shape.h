// Tells segments that a vehicle fits from those that none fits (VehicleShape).
//
// A pole is thin only if both of its ends are seen: a car that is almost hidden is no pole.
#pragma once

#include <span>

#include "sensors/laser/rectangle_fit.h"
#include "sensors/laser/segmentation.h"

namespace ttf::sensors::laser {

struct ShapeConfig {
  double thinnest_m = 0.5;   // 0: nothing is too thin
  double roughest_m = 0.25;  // root mean square of the range errors that the best outline leaves
};

// `object` is the fit of `points`, those of one segment with these ends. `noise` [m] is that of a range, `step` [rad] that
// of the beams.
VehicleShape shape_of(const ShapeConfig& config, const LaserObject& object, std::span<const PlanePoint> points,
                      const OutlineEnds& ends, double noise, double step);

}  // namespace ttf::sensors::laser
