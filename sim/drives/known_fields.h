// The scenario's tracker in a cluster. It has the fields of the emulated sensors, and the spans of radars, as far as the scenario says nothing
// else under `tracker.sensors`. The same holds for a drive in one program, in processes and on a real bus.
#pragma once

#include "fusion/config/tracker_config.h"
#include "schedules/model/cluster.h"
#include "sim/drives/scenario.h"

namespace ttf::sim::drives {

// Returns the tracker with its sensors by SensorId. A recorded sensor has no field but a stated one. Throws InputError if
// the scenario names a sensor that the cluster lacks.
fusion::config::TrackerConfig tracker_of(const Scenario& scenario, const schedules::model::Cluster& cluster);

}  // namespace ttf::sim::drives
