// The centre of an object of unknown heading, which lies behind its silhouette, along the line of sight.
//
// A rectangle L by W under a silhouette of width B has the mean chord L W / B. Its centre lies half of that behind. This is
// exact in the far field. The outermost corners are opposite ones: (u, v) and (-u, -v) from the centre. Here u = B / 2 and
// u^2 + v^2 = (L^2 + W^2) / 4. They move the silhouette's middle by u v / range, to an unknown side. No width may be
// measured. Then the mean of half the length and half the width counts.
#pragma once

#include <algorithm>
#include <cmath>

#include "fusion/tracks/body/extent.h"
#include "fusion/tracks/body/heading.h"

namespace ttf::fusion::tracks::body {

// The centre lies so far behind its silhouette [m]. The variances are along and across the line of sight [m^2].
struct Behind {
  double depth = 0.0, along = 0.0, across = 0.0;
};

// `shown` is the measured width B, and the range that of the silhouette [m].
inline Behind behind_of(const Extent& extent, const Scalar& shown, double range) {
  const double length = extent.size.maxCoeff(), width = extent.size.minCoeff();
  if (!shown.known) {
    const double spread = 0.5 * ((length - width) / std::sqrt(3.0) + width);
    return {0.25 * (length + width), spread * spread, spread * spread};
  }
  const double seen = std::clamp(shown.value, width, length), depth = 0.5 * length * width / seen;
  const linear::Vector<2> by_size = depth * extent.size.cwiseInverse();
  const double by_seen = depth / seen, half = 0.5 * seen, narrow = width / seen;
  const double far =
      std::max(0.0, 0.25 * (length * length + width * width) - half * half) / std::max(1.0, range * range);
  return {depth, by_size.dot(extent.covariance * by_size) + by_seen * by_seen * shown.variance,
          half * half * far * (1.0 - narrow * narrow) + 0.25 * shown.variance};
}

// Returns the covariance of the centre about that depth, for a line of sight along this unit vector.
inline linear::Matrix<2> covariance_of(const Behind& behind, const linear::Vector<2>& sight) {
  const linear::Vector<2> across(-sight.y(), sight.x());
  return behind.along * sight * sight.transpose() + behind.across * across * across.transpose();
}

}  // namespace ttf::fusion::tracks::body
