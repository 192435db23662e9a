// The layouts of lists that a kind of sensor is known by: those of the shipped clusters.
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "schedules/model/cluster.h"

namespace ttf::schedules::file::likeness {

// The lists that a sensor's device and its preprocessing send, without names and sensor.
struct KnownLayouts {
  model::PduLayout raw, objects;
};

// Returns nothing for a kind that cannot be copied: no task would take a second list of odometry.
std::optional<KnownLayouts> known_layouts(model::SensorKind kind);
std::vector<std::pair<std::string_view, model::SensorKind>> known_kinds();  // those with layouts

}  // namespace ttf::schedules::file::likeness
