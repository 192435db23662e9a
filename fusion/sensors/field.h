// The part of the plane that a sensor sees, in its own axes. As YAML, where every omitted key sets no bound:
//
//   field: {half_angle: 0.45, min_range: 1.0, max_range: 90.0, shadow: 0.5}
//
// Objects hide each other: each hides all behind it, up to the share `shadow` of its own distance. From a mast of
// height h, an object of height t has the shadow t / (h - t). A shadow of 0 hides nothing.
#pragma once

#include <limits>
#include <numbers>

namespace ttf::fusion::sensors {

struct Field {
  static constexpr double kUnbounded = std::numeric_limits<double>::infinity();

  double half_angle = kUnbounded;                  // [rad], seen to either side of the sensor's axis
  double min_range = 0.0, max_range = kUnbounded;  // [m]
  double shadow = kUnbounded;

  bool all_around() const { return half_angle >= std::numbers::pi; }
};

}  // namespace ttf::fusion::sensors
