// The scatter of returns about the faces that they lie on: its minor axis is the faces' common normal.
#pragma once

#include <cmath>
#include <numbers>

namespace ttf::sensors::laser {

// Moments of returns, relative to one of them: far from the sensor, squares would lose digits.
struct Moments {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  void add(double px, double py) {
    n += 1.0;
    x += px;
    y += py;
    xx += px * px;
    xy += px * py;
    yy += py * py;
  }
  Moments operator-(const Moments& o) const { return {n - o.n, x - o.x, y - o.y, xx - o.xx, xy - o.xy, yy - o.yy}; }
};

// The scatter of returns about their means; those of a left face are turned by a quarter, onto the right one's.
struct Scatter {
  double xx = 0.0, xy = 0.0, yy = 0.0;
  void add(const Moments& m, bool turned) {
    if (m.n == 0.0) return;
    const double mxx = m.xx - m.x * m.x / m.n, mxy = m.xy - m.x * m.y / m.n, myy = m.yy - m.y * m.y / m.n;
    xx += turned ? myy : mxx;
    xy += turned ? -mxy : mxy;
    yy += turned ? mxx : myy;
  }
  double least() const { return 0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy); }
  double minor_axis() const { return 0.5 * std::atan2(2.0 * xy, xx - yy) + 0.5 * std::numbers::pi; }
};

}  // namespace ttf::sensors::laser
