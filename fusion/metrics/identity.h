// The name of a true object or of a track in a comparison. It is unique at an instant and constant over time,
// and has no other meaning.
#pragma once

#include <cstdint>

#include "fusion/metrics/point.h"

namespace ttf::fusion::metrics {

using Identity = std::uint32_t;

struct Named {
  Identity name = 0;
  Point at;
};

// A true object and its track at an instant.
struct Match {
  Identity object = 0, track = 0;
  double distance_m = 0.0;
  bool switched = false;  // the object's last match was with another track
};

}  // namespace ttf::fusion::metrics
