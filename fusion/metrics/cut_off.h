// The two parameters of GOSPA and OSPA (set_distance.h).
#pragma once

#include "core/strict_yaml.h"

namespace ttf::fusion::metrics {

struct CutOff {
  double distance_m = 4.0;  // c, > 0 [m]
  double order = 2.0;       // p in [1, 64]
};

// Reads `cut_off`, 0.1..1000 m, and `order`, 1..16.
CutOff load_cut_off(YamlMap& yaml);

}  // namespace ttf::fusion::metrics
