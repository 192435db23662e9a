// A cheap test of a radar's observation against a track, before the filter's own: most pairs are far apart.
//
// The gate asks for nu' S^-1 nu, which is at least nu_k^2 / S_kk for every component k. Range and bearing each have a bound of
// nu_k from below and one of S_kk from above, without derivatives. d is the way from the sensor to the track's anchor, rho its
// length, and r the measured range. b is the distance of the observed point from the anchor, with covariance C
// (fusion/tracks/body/distance.h). P is the covariance of the anchor's position, and R that of the observation with the spread of its
// returns:
//   |nu_0| >= |r - rho| - |b|                         S_00 <= tr P + tr C + R_00
//   |nu_1| >= |sin(bearing - azimuth of d)| - |b| / r   S_11 <= tr P / rho^2 + tr C / r^2 + R_11
// They hold for filters to first order of one model without biases.
#pragma once

#include <algorithm>
#include <cmath>

#include "fusion/association/near_places.h"
#include "fusion/tracks/body/distance.h"

namespace ttf::fusion::tracks::parts {

// Returns whether the observation is certainly outside the gate of the track `at`. `sight` is the unit vector of its bearing
// in the tracks' axes; `distance` and `spread` may be null.
inline bool beyond_gate(const sensors::Observation& z, const linear::Vector<2>& sight,
                        const association::TrackPlace& at, const body::Distance* distance,
                        const linear::Matrix<3>* spread, double gate) {
  // As the range that a bearing's lever is taken for, at least (fusion/tracks/body/distance.cc).
  constexpr double kNearest = 0.1;
  constexpr double kRoundedUp = 1.0 + 1e-9;
  const double x = at.x - z.from.position.x(), y = at.y - z.from.position.y(), squared = x * x + y * y;
  if (!(squared > kNearest * kNearest)) return false;
  const double rho = std::sqrt(squared), range = std::max(kNearest, z.z(0));
  const double between = distance ? distance->between.norm() : 0.0,
               added = distance ? distance->constant.trace() + distance->noise.trace() : 0.0,
               p = at.variance_x + at.variance_y;
  const auto outside = [&](double off, double variance) {
    return off > 0.0 && off * off > kRoundedUp * gate * variance;
  };
  const auto spread_of = [&](Eigen::Index k) { return spread ? (*spread)(k, k) / z.returns : 0.0; };
  return outside(std::abs(z.z(0) - rho) - between, p + added + z.r(0, 0) + spread_of(0)) ||
         outside(std::abs(sight.x() * y - sight.y() * x) / rho - between / range,
                 p / squared + added / (range * range) + z.r(1, 1) + spread_of(1));
}

}  // namespace ttf::fusion::tracks::parts
