// One return of a laser scanner, as preprocessing receives it, emulated or recorded.
#pragma once

namespace ttf::sensors::laser {

struct ScanPoint {
  int layer = 0;
  double azimuth = 0.0;  // [rad], 0 ahead, positive left
  double range = 0.0;    // [m]
};

}  // namespace ttf::sensors::laser
