// Innovations of a list: of its observations that confirmed tracks took.
//
// Squares nu' S^-1 nu are those of the gate (fusion/tracks/parts/gate.h). They contain all uncertainty of the observed point
// (fusion/tracks/body/distance.h). With jpda they are those of the most probable joint event. Squares and degrees of freedom
// are sums. They are equal on the average if the filter judges its predictions rightly, except that the gate leaves out the
// largest squares (fusion/metrics/consistency.h).
#pragma once

#include <cstdint>

namespace ttf::fusion::tracks {

struct Innovations {
  double squares = 0.0;
  std::uint32_t degrees = 0;
};

}  // namespace ttf::fusion::tracks
