// The part of the plane that a sensor sees, in its own axes. As YAML, where every omitted key sets no bound:
//
//   field: {half_angle: 0.45, min_range: 1.0, max_range: 90.0, shadow: 0.5, blind: [{from: 0.3, to: 0.45}]}
//
// The sensor's own vehicle hides the blind sectors, which lie between two azimuths in the sensor's axes.
//
// Objects hide each other: each hides all behind it, up to the share `shadow` of its own distance. From a mast of
// height h, an object of height t has the shadow t / (h - t). A shadow of 0 hides nothing.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <numbers>

namespace ttf::fusion::sensors {

// From `from` to `to` [rad], counter-clockwise.
struct BlindSector {
  double from = 0.0, to = 0.0;
};

struct Field {
  static constexpr std::size_t kMostBlind = 4;
  static constexpr double kUnbounded = std::numeric_limits<double>::infinity();

  double half_angle = kUnbounded;                  // [rad], seen to either side of the sensor's axis
  double min_range = 0.0, max_range = kUnbounded;  // [m]
  double shadow = kUnbounded;
  std::array<BlindSector, kMostBlind> blind{};
  std::size_t blind_sectors = 0;

  bool all_around() const { return half_angle >= std::numbers::pi; }
};

}  // namespace ttf::fusion::sensors
