#include "sensors/laser/vehicle_shape.h"

#include <algorithm>
#include <cmath>

namespace ttf::sensors::laser {
namespace {

// An outline is rough only if so many returns say so, and if noise does not make it (in standard deviations).
constexpr std::size_t kFewestOfRough = 6;
constexpr double kNoiseOfRough = 3.0;

}  // namespace

VehicleShape shape_of(const ShapeConfig& config, const LaserObject& object, std::span<const PlanePoint> points,
                      const OutlineEnds& ends, double noise, double step) {
  if (points.size() >= kFewestOfRough && object.residual_m > std::max(config.roughest_m, kNoiseOfRough * noise))
    return VehicleShape::kRough;
  if (object.seen != ttf::fusion::sensors::SeenPoint::kSilhouette) return VehicleShape::kVehicle;
  const PlanePoint &first = points.front(), &last = points.back();
  // The outline ends up to one step beyond its last beams; half of that on the average.
  const double across = std::hypot(last.x - first.x, last.y - first.y) + step * 0.5 * (first.range + last.range);
  if (!ends[0].hidden && !ends[1].hidden && across < config.thinnest_m) return VehicleShape::kThin;
  return VehicleShape::kPart;
}

}  // namespace ttf::sensors::laser
