// An object's outline as a sensor at the origin sees it.
#pragma once

#include <array>
#include <optional>

#include "sim/world/world.h"

namespace ttf::sim::world {

struct Corner {
  double x = 0, y = 0;
};
// Counter-clockwise, from the front left.
std::array<Corner, 4> corners(const ObjectState& state);

// An outline made ready for many rays.
class RayTarget {
 public:
  explicit RayTarget(const ObjectState& state);
  // Distance from the origin along `azimuth` to the outline, if the ray meets it.
  std::optional<double> ray_to(double azimuth) const;

 private:
  // In the object's frame the outline is a box: where the origin lies, and half of the size.
  double heading_;
  double origin_[2];
  double half_[2];
};

// Azimuths between which the outline lies (low <= high); nothing where it surrounds the origin or lies behind it.
struct AzimuthSpan {
  double low = 0, high = 0;
};
std::optional<AzimuthSpan> azimuth_span(const ObjectState& state);

}  // namespace ttf::sim::world
