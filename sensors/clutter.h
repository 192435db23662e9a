// The number of false detections in a list.
#pragma once

#include <cmath>

#include "core/random.h"

namespace ttf::sensors {

// Draws from a Poisson distribution (Knuth: "The Art of Computer Programming", vol. 2, 3.4.1, algorithm Q).
inline int poisson(RandomStream& stream, double mean) {
  const double limit = std::exp(-mean);
  int count = -1;
  for (double product = 1.0; product > limit || count < 0; ++count) product *= stream.uniform();
  return count;
}

}  // namespace ttf::sensors
