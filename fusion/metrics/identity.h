// Who is who on either side of a comparison: a true object's name, or a track's. Unique at an instant, and for one
// object or track the same at all instants; else without meaning.
#pragma once

#include <cstdint>

#include "fusion/metrics/point.h"

namespace ttf::fusion::metrics {

using Identity = std::uint32_t;

struct Named {
  Identity name = 0;
  Point at;
};

// A true object and the track that follows it at an instant.
struct Match {
  Identity object = 0, track = 0;
  double distance_m = 0.0;
  bool switched = false;  // another track followed the object when it was last matched
};

}  // namespace ttf::fusion::metrics
