// Checks of adaptive cameras (nodes/vision).
#pragma once

#include "core/errors.h"
#include "nodes/vision/config.h"
#include "schedules/model/cluster.h"
#include "sim/drives/scenario.h"

namespace ttf::sim::drives {

// Returns the cameras that share the detector, in the order of the ports read.
std::vector<SensorId> cameras_of(const schedules::model::Cluster& cluster, const schedules::model::Task& task);
// Returns whether somebody looks at this camera's regions of interest: the detector, if the cluster has one.
bool looks_at_regions(const schedules::model::Cluster& cluster, SensorId camera);

// Checks the cluster's adaptive cameras; their ports are bound.
void check_detectors(const schedules::model::Cluster& cluster, Findings& findings);
// Checks the scenario's times and regions of interest against a detector of the cluster.
void check_detection(const Scenario& scenario, const schedules::model::Cluster& cluster,
                     const schedules::model::Node& node, const schedules::model::Task& task, Findings& findings);

// Returns the pictures of the detector's cameras, as the scenario describes them.
std::vector<nodes::vision::SharedCamera> pictures_of(const Scenario& scenario, const schedules::model::Cluster& cluster,
                                                     const schedules::model::Task& task);

}  // namespace ttf::sim::drives
