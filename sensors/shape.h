// An object's outline, seen by a sensor at the origin.
#pragma once

#include <array>
#include <optional>

#include "sensors/scene.h"

namespace ttf::sensors {

struct Corner {
  double x = 0, y = 0;
};
// Returns the corners counter-clockwise, from the front left.
std::array<Corner, 4> corners(const ObjectState& state);

// An outline prepared for many rays.
class RayTarget {
 public:
  explicit RayTarget(const ObjectState& state);
  // Returns the distance from the origin along `azimuth` to the outline, if the ray meets it.
  std::optional<double> ray_to(double azimuth) const;

 private:
  // In the object's frame the outline is a box: the place of the origin, and half of the size.
  double heading_;
  double origin_[2];
  double half_[2];
};

// The azimuths between which the outline lies (low <= high). Absent if the outline surrounds the origin or
// comes so close that a corner is more than a quarter turn from the centre's direction.
struct AzimuthSpan {
  double low = 0, high = 0;
};
std::optional<AzimuthSpan> azimuth_span(const ObjectState& state);

}  // namespace ttf::sensors
