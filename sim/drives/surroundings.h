// The world and the reference of a drive. A simulation, a node in real time and the truth added afterwards share
// them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "recording/rows/laser_radar_file.h"
#include "schedules/model/cluster.h"
#include "sensors/scene.h"
#include "sim/drives/observer.h"
#include "sim/drives/scenario.h"
#include "sim/world/reference.h"

namespace ttf::sim::drives {

struct Surroundings {
  std::shared_ptr<const sensors::Scene> scene;
  std::shared_ptr<const sensors::WorldScene> world;  // the same scene; null if it is recorded or traced
  std::optional<sim::world::Reference> reference;    // in a world: of the first object with a reference

  // Makes the observer record the reference, too, and judge what the cluster's sensors have in view. This must outlive the observer.
  void show(Observer& observer, const Scenario& scenario, const schedules::model::Cluster& cluster) const;
};

// `recorded` is null for a cluster without a recording.
Surroundings surroundings_of(const Scenario& scenario, const schedules::model::Cluster& cluster, std::uint64_t seed,
                             std::uint32_t replication,
                             const std::shared_ptr<const recording::rows::RecordedInput>& recorded);

// Returns a warning if the sensors' vehicle moves and the fusion reads no odometry; else "". The vehicle is that of the scenario or
// of its trace.
std::string motion_warning(const Scenario& scenario, const schedules::model::Cluster& cluster);

}  // namespace ttf::sim::drives
