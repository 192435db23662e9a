// Reads the keys of the tracker, and of the measures that judge it.
#pragma once

#include "core/strict_yaml.h"
#include "fusion/config/tracker_config.h"
#include "fusion/metrics/cut_off.h"

namespace ttf::fusion::loading {

// Whether the tracker's own keys say what is known of the sensors.
enum class SensorsAre : unsigned char { kHere, kElsewhere };
config::TrackerConfig load_tracker(YamlMap& yaml, SensorsAre sensors = SensorsAre::kHere);

// Reads `cut_off`, 0.1..1000 m, and `order`, 1..16, of GOSPA and OSPA.
metrics::CutOff load_cut_off(YamlMap& yaml);

}  // namespace ttf::fusion::loading
