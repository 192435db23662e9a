// Objects in the plane as an image shows them, and the gate for their match with true objects.
#pragma once

namespace ttf::evaluation::accuracy {

struct PlaneEstimate {
  double x = 0.0, y = 0.0, vx = 0.0, vy = 0.0;  // [m], [m/s]
};

// The largest distance [m] between an image's object and a true object that may be matched.
inline constexpr double kGate_m = 4.0;

}  // namespace ttf::evaluation::accuracy
