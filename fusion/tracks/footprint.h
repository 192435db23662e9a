// The place that an object covers in the plane, and whether two of them share some of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "fusion/tracks/view.h"

namespace ttf::fusion::tracks {

// A rectangle about (x, y) [m]; the length is along the heading [rad].
struct Footprint {
  double x = 0.0, y = 0.0, heading = 0.0, length = 0.0, width = 0.0;
};

// Returns how deep two rectangles overlap [m]: the shortest way along one of their axes that takes them apart. It is 0 or
// less if they do not overlap (the theorem of the separating axis: Gottschalk, Lin, Manocha: "OBBTree", SIGGRAPH 1996).
inline double overlap_depth(const Footprint& a, const Footprint& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const auto half_along = [](const Footprint& of, double angle) {
    return 0.5 *
           (of.length * std::abs(std::cos(of.heading - angle)) + of.width * std::abs(std::sin(of.heading - angle)));
  };
  constexpr double kQuarter = 1.5707963267948966;
  double depth = std::numeric_limits<double>::infinity();
  for (const double angle : {a.heading, a.heading + kQuarter, b.heading, b.heading + kQuarter})
    depth = std::min(
        depth, half_along(a, angle) + half_along(b, angle) - std::abs(dx * std::cos(angle) + dy * std::sin(angle)));
  return depth;
}

// Returns the place that a track surely covers: each side is two standard deviations shorter than its estimate. A side
// that was not measured has the typical size, and a large deviation.
inline Footprint footprint_of(const TrackView& track) {
  return {track.state(0), track.state(1), track.heading, std::max(0.0, track.length - 2.0 * track.sigma_length),
          std::max(0.0, track.width - 2.0 * track.sigma_width)};
}

}  // namespace ttf::fusion::tracks
