// The layouts of lists that a kind of sensor is known by: those of the shipped clusters.
#pragma once

#include <optional>

#include "schedules/model/cluster.h"

namespace ttf::schedules::synthesis::plan {

// The lists that a sensor's device and its preprocessing send.
struct KnownKind {
  const char* measuring_step;
  const char* preprocessing_step;
  model::PduLayout raw, objects;  // without names and sensor
};

// Returns nothing for kinds whose lists have no layout of their own.
std::optional<KnownKind> known_kind(model::SensorKind kind);

}  // namespace ttf::schedules::synthesis::plan
