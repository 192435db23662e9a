// Reads the tracker's keys.
#pragma once

#include "core/strict_yaml.h"
#include "fusion/config/tracker_config.h"

namespace ttf::fusion::loading {

// Whether the tracker's own keys say what is known of the sensors.
enum class SensorsAre : unsigned char { kHere, kElsewhere };
config::TrackerConfig load_tracker(YamlMap& yaml, SensorsAre sensors = SensorsAre::kHere);

}  // namespace ttf::fusion::loading
