// Trackers with classes, and observations that report one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string_view>

#include "fusion/config/tracker_config.h"
#include "fusion/sensors/observation.h"

namespace ttf::fusion {

// Without names: all classes.
inline config::TrackerConfig with_classes(std::initializer_list<std::string_view> names = {}) {
  config::TrackerConfig config;
  for (const config::ClassPrior& prior : config::kClassPriors)
    if (names.size() == 0 || std::find(names.begin(), names.end(), prior.name) != names.end())
      config.classes.push_back(prior);
  return config;
}

inline sensors::Observation reported(sensors::Observation z, std::size_t id) {
  z.class_id = static_cast<sensors::ClassId>(id);
  z.score = 1.0;
  return z;
}

}  // namespace ttf::fusion
