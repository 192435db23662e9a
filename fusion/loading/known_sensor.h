// Reads the fusion's knowledge of a sensor; fusion/sensors/known_sensor.h has the keys.
#pragma once

#include <span>
#include <string_view>

#include "core/strict_yaml.h"
#include "fusion/sensors/known_sensor.h"

namespace ttf::fusion::loading {

// Reads `mounting`, `field`, `range_rate_span`, `bias` and `bias_sigma`. The caller sets name and line.
sensors::KnownSensor load_known_sensor(YamlMap& yaml);

// Reports a finding about `key` when the sensors have more biases than a tracker carries.
void check_biases(std::span<const sensors::KnownSensor> sensors, YamlMap& yaml, std::string_view key);

}  // namespace ttf::fusion::loading
