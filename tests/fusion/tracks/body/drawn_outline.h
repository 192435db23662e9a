// Points on the visible outline of a box, as a radar at the origin may meet them: an oracle by the four edges, without the
// formulas of fusion/tracks/body.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"
#include "fusion/linear/gaussian.h"
#include "fusion/tracks/body/anchor.h"
#include "fusion/tracks/body/returns.h"

namespace ttf::fusion::tracks::body {

// The box lies ahead of the origin.
class DrawnOutline {
 public:
  DrawnOutline(const linear::Vector<2>& centre, const Box& box) {
    const linear::Vector<2> along(std::cos(box.heading), std::sin(box.heading)), across(-along.y(), along.x());
    constexpr std::array<std::array<double, 2>, 4> kCorners{{{0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}}};
    for (std::size_t i = 0; i < 4; ++i) {
      corners_[i] = centre + kCorners[i][0] * box.size(0) * along + kCorners[i][1] * box.size(1) * across;
      low_ = std::min(low_, std::atan2(corners_[i].y(), corners_[i].x()));
      high_ = std::max(high_, std::atan2(corners_[i].y(), corners_[i].x()));
    }
  }

  // Returns the range [m] of the first of the four edges that the ray meets.
  double range_at(double azimuth) const {
    const double dx = std::cos(azimuth), dy = std::sin(azimuth);
    double range = 1e9;
    for (std::size_t i = 0; i < 4; ++i) {
      const linear::Vector<2> a = corners_[i], e = corners_[(i + 1) % 4] - a;
      const double determinant = dy * e.x() - dx * e.y();
      if (std::abs(determinant) < 1e-12) continue;
      const double at = (a.y() * e.x() - a.x() * e.y()) / determinant, along = (dx * a.y() - dy * a.x()) / determinant;
      if (at > 0 && along >= 0 && along <= 1) range = std::min(range, at);
    }
    return range;
  }

  // Draws range and azimuth of a point, evenly over the azimuths.
  linear::Vector<2> draw(RandomStream& stream) const {
    const double azimuth = stream.uniform(low_, high_);
    return {range_at(azimuth), azimuth};
  }

  // Returns mean range and mean azimuth.
  linear::Vector<2> mean() const {
    constexpr int kRays = 128;
    double sum = 0.0;
    for (int k = 0; k < kRays; ++k) sum += range_at(low_ + (high_ - low_) * (k + 0.5) / kRays);
    return {sum / kRays, 0.5 * (low_ + high_)};
  }

 private:
  std::array<linear::Vector<2>, 4> corners_;
  double low_ = 10.0, high_ = -10.0;  // azimuths of the outermost corners
};

inline linear::Vector<2> plane_of(const linear::Vector<2>& polar) {
  return polar(0) * linear::Vector<2>(std::cos(polar(1)), std::sin(polar(1)));
}

// Returns the range rate [m/s] of matter at `polar` of a body that turns with `turn_rate` about `at`, which has this
// velocity.
inline double range_rate_of(const linear::Vector<2>& polar, const linear::Vector<2>& at,
                            const linear::Vector<2>& velocity, double turn_rate) {
  const linear::Vector<2> lever = plane_of(polar) - at;
  return std::cos(polar(1)) * (velocity.x() - turn_rate * lever.y()) +
         std::sin(polar(1)) * (velocity.y() + turn_rate * lever.x());
}

// A car of 4.4 m by 1.8 m that drives along its heading.
inline SeenBox seen_car(double x, double y, double heading, double speed, double turn_rate = 0.0) {
  SeenBox o;
  o.centre << x, y;
  o.box.size << 4.4, 1.8;
  o.box.heading = heading;
  o.velocity << speed * std::cos(heading), speed * std::sin(heading);
  o.turn_rate = turn_rate;
  return o;
}

}  // namespace ttf::fusion::tracks::body
