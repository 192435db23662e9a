// Reads the sensors of a scenario, and compares them with a cluster.
#pragma once

#include <string>

#include "core/strict_yaml.h"
#include "schedules/model/cluster.h"
#include "sensors/kinds/sensors.h"

namespace ttf::sensors::kinds {

// Reads `sensors`, and into the result `preprocessing`.
Sensors load_sensors(YamlMap& yaml);
void load_preprocessing(YamlMap& yaml, Sensors& sensors);

// Checks that the cluster has every sensor with an entry of its own. Its kind and its period must be the same there,
// and no recording may play it. `text` is the scenario's, which findings name by `file`. Throws InputError with every finding.
void check_sensors(const Sensors& sensors, const std::string& text, const std::string& file,
                   const schedules::model::Cluster& cluster);

}  // namespace ttf::sensors::kinds
