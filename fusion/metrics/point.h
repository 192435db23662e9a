// A position in the plane, as the metrics compare them.
#pragma once

#include <cmath>

namespace ttf::fusion::metrics {

struct Point {
  double x = 0.0, y = 0.0;  // [m], any frame that both sides share
};

inline double distance_m(const Point& a, const Point& b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace ttf::fusion::metrics
