// The two parameters of GOSPA and OSPA (set_distance.h).
#pragma once

namespace ttf::fusion::metrics {

struct CutOff {
  double distance_m = 4.0;  // c, > 0 [m]
  double order = 2.0;       // p in [1, 64]
};

}  // namespace ttf::fusion::metrics
