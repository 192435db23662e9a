// The sides of a sensor that its own vehicle hides: sectors of azimuths, in the sensor's axes. Nothing is measured there.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace ttf::sensors {

// From `from` to `to` [rad], counter-clockwise.
struct BlindSector {
  double from = 0.0, to = 0.0;
  bool holds(double azimuth) const {
    return std::abs(std::remainder(azimuth - 0.5 * (from + to), 2.0 * std::numbers::pi)) <= 0.5 * (to - from);
  }
};

struct BlindSides {
  static constexpr std::size_t kMost = 4;
  std::array<BlindSector, kMost> sectors{};
  std::size_t count = 0;

  bool hold(double azimuth) const {
    for (std::size_t i = 0; i < count; ++i)
      if (sectors[i].holds(azimuth)) return true;
    return false;
  }
};

}  // namespace ttf::sensors
