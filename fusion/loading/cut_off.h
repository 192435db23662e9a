// Reads the parameters of GOSPA and OSPA.
#pragma once

#include "core/strict_yaml.h"
#include "fusion/metrics/cut_off.h"

namespace ttf::fusion::loading {

// Reads `cut_off`, 0.1..1000 m, and `order`, 1..16.
metrics::CutOff load_cut_off(YamlMap& yaml);

}  // namespace ttf::fusion::loading
